#pragma once

#include <tether/record/reader.h>

namespace tether::judge {

/// When the SUT sent a request and had its reply, in ST. Under the barrier by its own timestamps,
/// which are those of ST; in free running by when the coordinator had the request and sent the
/// reply.
class Times {
 public:
  explicit Times(const record::Record& record)
      : is_free_(record.header.policy == record::kFreeRunning) {}

  SimTime sent(const record::Interaction& i) const {
    return is_free_ ? i.st_at_arrival : same_instant(i.request_at);
  }
  SimTime answered(const record::Interaction& i) const {
    return is_free_ ? i.st_at_release : same_instant(i.reply_at);
  }
  SimTime noted(const record::Logged<record::Annotation>& note) const {
    return is_free_ ? note.at : same_instant(note.message.at);
  }

 private:
  bool is_free_;
};

/// ST of the end of a run.
inline SimTime end_of(const record::Record& record) {
  return record.footer ? record.footer->st_at_end : record::last_time(record);
}

}  // namespace tether::judge
