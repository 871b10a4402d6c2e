#pragma once

#include "supervision.h"

#include <optional>
#include <vector>

#include <tether/base/time.h>

namespace tether::supervisor {

/// The programs of one board. They compete for its cores, so they run and stop together, and have
/// one ET: the group stops when a member must stop, that ET is the stop of each member, and the
/// group goes on when all members may. A member that is over does not count. Pure logic.
class Group {
 public:
  /// Adds a member, which must outlive the group. @pre is_running()
  void add(Supervision& member) { members_.push_back(&member); }
  bool has(const Supervision& member) const;

  bool is_running() const { return running_; }
  /// @pre is_running()
  bool must_stop(ExecTime now) const;
  /// The next instant at which the group must stop, as far as known.
  std::optional<ExecTime> stop_at() const;
  /// All programs are stopped since `at`, and their earlier requests were passed on. Their ET
  /// becomes `at` or, if a reply is due at that very instant, a later one. @pre is_running()
  void stopped(ExecTime at);
  /// The same for a reply that has become due at the instant of the stop since. Call it after each
  /// message of the coordinator.
  void pass_dues();
  /// @pre !is_running()
  bool may_go_on() const;
  /// The group continues; ET continues from `stopped_at`. @pre may_go_on()
  void go_on();
  ExecTime stopped_at() const { return stopped_at_; }

 private:
  bool is_due_at(ExecTime t) const;

  std::vector<Supervision*> members_;
  bool running_ = true;
  ExecTime stopped_at_{};
};

}  // namespace tether::supervisor
