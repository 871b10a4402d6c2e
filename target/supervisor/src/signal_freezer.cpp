#include "freezer.h"
#include "process_tree.h"
#include "waiting.h"

#include <set>
#include <utility>
#include <vector>

#include <signal.h>
#include <unistd.h>

namespace tether::supervisor {
namespace {

std::vector<pid_t> own_children_of(const std::vector<ProcessState>& processes) {
  std::vector<pid_t> children;
  for (const ProcessState& process : processes) {
    if (process.parent == ::getpid()) children.push_back(process.id);
  }
  return children;
}

class SignalFreezer final : public Freezer {
 public:
  explicit SignalFreezer(pid_t guardian) : processes_(guardian) {}

  void add(pid_t group) override { groups_.insert(group); }
  void remove(pid_t group) override { groups_.erase(group); }
  std::string name() const override { return "signal"; }
  Status freeze() override {
    for (const pid_t group : groups_) ::kill(-group, SIGSTOP);
    if (wait_until([this] { return all_stand_still(); }, kLongestFreeze)) return ok_status();
    return Failure{Failure::Kind::kTimeout,
                   "a thread of the command does not stop on SIGSTOP (--freezer cgroup stops "
                   "more)"};
  }
  void thaw() override {
    for (const pid_t group : groups_) ::kill(-group, SIGCONT);
    for (const pid_t process : outside_) ::kill(process, SIGCONT);
    outside_.clear();
  }

 private:
  // Processes whose parent ends while all are looked at become children of this one: a look counts
  // only if these are still the same after it. The group's SIGSTOP may reach a process that is just
  // leaving the group, which then stops outside, where the group's SIGCONT does not reach it. A
  // process that was outside before and has stopped is stopped by its own will.
  bool all_stand_still() {
    const auto found = processes_.look();
    const auto rest = at_rest(found, share_memory);
    bool all = true;
    std::set<pid_t> outside;
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (!rest[i]) all = false;
      if (found[i].group == 0 || groups_.contains(found[i].group)) continue;
      const pid_t process = found[i].id;
      outside.insert(process);
      const bool may_have_stopped_while_leaving = !known_outside_.contains(process);
      if ((!rest[i] || may_have_stopped_while_leaving) && outside_.insert(process).second)
        ::kill(process, SIGSTOP);
    }
    if (!all || processes_.own_children() != own_children_of(found)) return false;
    known_outside_ = std::move(outside);
    return true;
  }

  std::set<pid_t> groups_;
  ProcessTree processes_;
  std::set<pid_t> outside_;        // stopped one by one, having left the group
  std::set<pid_t> known_outside_;  // at the end of the last freeze
};

}  // namespace

Result<std::unique_ptr<Freezer>> make_signal_freezer(pid_t guardian) {
  if (ProcessTree::is_listed()) {
    return std::unique_ptr<Freezer>(std::make_unique<SignalFreezer>(guardian));
  }
  return Failure{Failure::Kind::kInvalid,
                 "this kernel does not list the children of processes (CONFIG_PROC_CHILDREN)"};
}

}  // namespace tether::supervisor
