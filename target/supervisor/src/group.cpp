#include "group.h"

#include <algorithm>

namespace tether::supervisor {

bool Group::has(const Supervision& member) const {
  return std::ranges::find(members_, &member) != members_.end();
}

bool Group::must_stop(ExecTime now) const {
  return std::ranges::any_of(members_, [now](const auto* m) { return m->must_stop(now); });
}

std::optional<ExecTime> Group::stop_at() const {
  std::optional<ExecTime> least;
  for (const Supervision* member : members_) {
    const auto at = member->is_over() ? std::nullopt : member->stop_at();
    if (at && (!least || *at < *least)) least = at;
  }
  return least;
}

bool Group::is_due_at(ExecTime t) const {
  return std::ranges::any_of(members_, [t](const auto* m) { return m->awaits_reply_at(t); });
}

// No member has sent a later ET: each of them was read from the group's clock before. At the time
// of a due reply, another member, which is stopped too, could still send a message that it has to
// wait for: all of them would wait for ever.
void Group::stopped(ExecTime at) {
  running_ = false;
  while (is_due_at(at)) at += Duration(1);
  stopped_at_ = at;
  for (Supervision* member : members_)
    if (!member->is_over()) member->stopped(at);
}

void Group::pass_dues() {
  if (!running_ && is_due_at(stopped_at_)) stopped(stopped_at_);
}

bool Group::may_go_on() const {
  return std::ranges::all_of(members_, [](const auto* m) { return m->may_go_on(); });
}

void Group::go_on() {
  running_ = true;
  for (Supervision* member : members_)
    if (!member->is_running()) member->go_on();
}

}  // namespace tether::supervisor
