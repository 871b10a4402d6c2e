#include "freezer.h"
#include "process_tree.h"
#include "waiting.h"

#include <set>
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
  SignalFreezer(pid_t group, pid_t guardian) : group_(group), processes_(guardian) {}

  std::string name() const override { return "signal"; }
  Status freeze() override {
    ::kill(-group_, SIGSTOP);
    if (wait_until([this] { return all_stand_still(); }, kLongestFreeze)) return ok_status();
    return Failure{Failure::Kind::kTimeout,
                   "a thread of the command does not stop on SIGSTOP (--freezer cgroup stops "
                   "more)"};
  }
  void thaw() override {
    ::kill(-group_, SIGCONT);
    for (const pid_t process : outside_) ::kill(process, SIGCONT);
    outside_.clear();
  }

 private:
  // Processes whose parent ends while all are looked at become children of this one: a look counts
  // only if these are still the same after it.
  bool all_stand_still() {
    const auto found = processes_.look();
    const auto rest = at_rest(found, share_memory);
    bool all = true;
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (rest[i]) continue;
      all = false;
      const bool outside = found[i].group != 0 && found[i].group != group_;
      if (outside && outside_.insert(found[i].id).second) ::kill(found[i].id, SIGSTOP);
    }
    return all && processes_.own_children() == own_children_of(found);
  }

  pid_t group_;
  ProcessTree processes_;
  std::set<pid_t> outside_;  // stopped one by one, having left the group
};

}  // namespace

Result<std::unique_ptr<Freezer>> make_signal_freezer(pid_t group, pid_t guardian) {
  if (ProcessTree::is_listed()) {
    return std::unique_ptr<Freezer>(std::make_unique<SignalFreezer>(group, guardian));
  }
  return Failure{Failure::Kind::kInvalid,
                 "this kernel does not list the children of processes (CONFIG_PROC_CHILDREN)"};
}

}  // namespace tether::supervisor
