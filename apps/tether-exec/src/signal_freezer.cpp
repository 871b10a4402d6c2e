#include "freezer.h"
#include "process_tree.h"
#include "waiting.h"

#include <signal.h>

namespace tether::exec {
namespace {

class SignalFreezer final : public Freezer {
 public:
  explicit SignalFreezer(pid_t group) : group_(group) {}

  std::string name() const override { return "signal"; }
  Status freeze() override {
    ::kill(-group_, SIGSTOP);
    if (wait_until([this] { return processes_.all_stopped(group_); }, kLongestFreeze)) {
      return ok_status();
    }
    return Failure{Failure::Kind::kTimeout, "a thread of the command does not stop"};
  }
  void thaw() override { ::kill(-group_, SIGCONT); }

 private:
  pid_t group_;
  ProcessTree processes_;
};

}  // namespace

Result<std::unique_ptr<Freezer>> make_signal_freezer(pid_t group) {
  if (ProcessTree::is_listed()) {
    return std::unique_ptr<Freezer>(std::make_unique<SignalFreezer>(group));
  }
  return Failure{Failure::Kind::kInvalid,
                 "this kernel does not list the children of processes (CONFIG_PROC_CHILDREN)"};
}

}  // namespace tether::exec
