#include "supervision.h"

#include <algorithm>
#include <string>
#include <utility>

// The rules for a group of threads as pure logic: instants and messages in, decisions out. A
// request stops the group; it continues when the coordinator has announced the reply times of all
// requests, and stops again at the earliest of them. No caller receives a reply before its time.
namespace tether::supervisor {
namespace {

Failure wrong(const std::string& what, std::uint64_t sequence) {
  return {Failure::Kind::kProtocol, "protocol violation: the coordinator sent " + what +
                                        " for request " + std::to_string(sequence)};
}

}  // namespace

Supervision::Supervision(bool free_running, ExecTime start)
    : free_running_(free_running), stopped_at_(start), last_sent_(start) {}

// --- from the callers ---------------------------------------------------------------------------

void Supervision::asked(CallerId caller, link::Request request) {
  if (over_) return refuse(caller);
  if (free_running_) return forward({caller, std::move(request)}, ExecTime::max());
  asked_.push_back({caller, std::move(request)});
}

void Supervision::gone(CallerId caller) {
  for (auto& [sequence, open] : open_) {
    if (open.caller == caller) open.caller = 0;
  }
  for (Asked& asked : asked_) {
    if (asked.caller == caller) asked.caller = 0;
  }
}

void Supervision::annotated(link::Annotation annotation) {
  if (!over_) outgoing_.emplace_back(std::move(annotation));
}

// The request as the coordinator gets it. A thread may have been stopped between stamping it and
// handing it over, or have waited for others: it is issued when it can no longer be before anything
// that was said.
void Supervision::forward(Asked asked, ExecTime latest) {
  link::Request& request = asked.request;
  Open open;
  open.caller = asked.caller;
  open.callers_sequence = std::exchange(request.sequence, ++sequence_);
  const ExecTime stamp = request.issued_at;
  request.issued_at = std::max(std::min(stamp, latest), last_sent_);
  if (auto* sleep = std::get_if<link::Sleep>(&request.body); sleep && sleep->is_relative)
    sleep->until += request.issued_at - stamp;
  open.issued_at = last_sent_ = request.issued_at;
  open.finishes = std::holds_alternative<link::Finish>(request.body);
  open.receives = std::holds_alternative<link::ReceiveMessage>(request.body);
  open_.emplace(sequence_, std::move(open));
  outgoing_.emplace_back(std::move(request));
}

// --- from the coordinator -----------------------------------------------------------------------

Status Supervision::heard(const link::Due& due) {
  const auto found = open_.find(due.sequence);
  if (found == open_.end() || free_running_) {
    return wrong("an unexpected reply time", due.sequence);
  }
  Open& open = found->second;
  if (due.reply_at < open.issued_at) return wrong("a reply time before the request", due.sequence);
  if (open.due && (!open.receives || open.reply || due.reply_at > *open.due))
    return wrong("another reply time", due.sequence);
  // It is stopped, and does not go on without the reply: as if it had stopped for it.
  const bool stops_longer = open.due && !running_ && due.reply_at <= stopped_at_;
  open.due = due.reply_at;
  ++dues_heard_;
  if (stops_longer) outgoing_.emplace_back(stop_message());
  return ok_status();
}

Status Supervision::heard(link::Reply reply) {
  const auto found = open_.find(reply.sequence);
  if (found == open_.end() || found->second.reply) {
    return wrong("an unexpected reply", reply.sequence);
  }
  Open& open = found->second;
  if (!free_running_) {
    if (!open.due) return wrong("a reply before its reply time", reply.sequence);
    if (*open.due != reply.resume_at) {
      return wrong("a reply with another time than announced", reply.sequence);
    }
  }
  reply.sequence = open.callers_sequence;
  open.reply = std::move(reply);
  if (!free_running_) return ok_status();
  Open done = std::move(open);
  open_.erase(found);
  hand_out(std::move(done));
  return ok_status();
}

void Supervision::end(std::optional<link::Refusal> why) {
  if (over_) return;
  over_ = true;
  why_over_ = std::move(why);
  hand_out_what_is_there();
  for (const auto& [sequence, open] : std::exchange(open_, {})) refuse(open.caller);
  for (const Asked& asked : std::exchange(asked_, {})) refuse(asked.caller);
}

// The coordinator closes right after it has answered a finish, so the end may be heard in one go
// with replies.
void Supervision::hand_out_what_is_there() {
  for (auto it = open_.begin(); it != open_.end();) {
    const Open& open = it->second;
    if (!open.reply || (!open.finishes && open.reply->resume_at > last_sent_)) {
      ++it;
      continue;
    }
    Open done = std::move(it->second);
    it = open_.erase(it);
    hand_out(std::move(done));
  }
}

void Supervision::refuse(CallerId caller) {
  if (caller == 0) return;
  if (why_over_) {
    answers_.push_back({caller, *why_over_});
  } else {
    answers_.push_back({caller, std::nullopt});
  }
}

void Supervision::hand_out(Open open) {
  if (open.caller != 0) answers_.push_back({open.caller, std::move(*open.reply)});
  if (!open.finishes) return;
  finished_ = true;
  link::Refusal why{link::Refusal::Reason::kRunEnded,
                    "another thread of the program finished the mission"};
  if (over_) {
    why_over_ = std::move(why);
  } else {
    end(std::move(why));
  }
}

// --- stopping and going on ----------------------------------------------------------------------

bool Supervision::must_stop(ExecTime now) const {
  if (over_ || free_running_) return false;
  const auto due = stop_at();
  return !asked_.empty() || (due && now >= *due);
}

std::optional<ExecTime> Supervision::stop_at() const {
  std::optional<ExecTime> least;
  for (const auto& [sequence, open] : open_) {
    if (open.due && (!least || *open.due < *least)) least = open.due;
  }
  return least;
}

bool Supervision::awaits_reply_at(ExecTime t) const {
  return !over_ && std::ranges::any_of(open_, [t](const auto& entry) {
    return entry.second.due == t && !entry.second.reply;
  });
}

void Supervision::stopped(ExecTime at) {
  running_ = false;
  stopped_at_ = std::max(at, last_sent_);
  std::stable_sort(asked_.begin(), asked_.end(), [](const Asked& a, const Asked& b) {
    return a.request.issued_at < b.request.issued_at;
  });
  for (Asked& asked : std::exchange(asked_, {})) forward(std::move(asked), stopped_at_);
  last_sent_ = stopped_at_;
  outgoing_.emplace_back(stop_message());
}

link::Progress Supervision::stop_message() const {
  return {.reached = stopped_at_, .stopped = true, .dues_heard = dues_heard_};
}

bool Supervision::may_go_on() const {
  return over_ || std::all_of(open_.begin(), open_.end(), [this](const auto& entry) {
           const Open& open = entry.second;
           return open.due && (*open.due > stopped_at_ || open.reply);
         });
}

void Supervision::go_on() {
  running_ = true;
  for (auto it = open_.begin(); it != open_.end();) {
    if (*it->second.due > stopped_at_) {
      ++it;
      continue;
    }
    Open done = std::move(it->second);
    it = open_.erase(it);
    if (done.finishes) return hand_out(std::move(done));
    hand_out(std::move(done));
  }
}

void Supervision::progressed(ExecTime now) {
  if (!running_ || over_ || now <= last_sent_) return;
  last_sent_ = now;
  outgoing_.emplace_back(link::Progress{now, false});
}

std::vector<link::Message> Supervision::take_outgoing() {
  return std::exchange(outgoing_, {});
}

std::vector<Answer> Supervision::take_answers() {
  return std::exchange(answers_, {});
}

}  // namespace tether::supervisor
