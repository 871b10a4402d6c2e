#pragma once

#include <memory>
#include <string>

#include <sys/types.h>

#include <tether/base/result.h>
#include <tether/base/time.h>

namespace tether::supervisor {

/// Stops every thread of the commands' processes, and lets them go again.
class Freezer {
 public:
  virtual ~Freezer() = default;
  /// Another command, by its process group, whose first process is a child of this one. Call it
  /// while none is stopped.
  virtual void add(pid_t group) = 0;
  /// One of them, of whose group nothing is left.
  virtual void remove(pid_t group) = 0;
  /// What it is called on the command line: "cgroup" or "signal".
  virtual std::string name() const = 0;
  /// Returns when no thread runs any more. Fails with kTimeout if one does not stop.
  virtual Status freeze() = 0;
  virtual void thaw() = 0;
};

/// A thread that hangs in the kernel (a dead network disk) cannot be stopped.
inline constexpr Duration kLongestFreeze = std::chrono::seconds(5);

/// A cgroup v2 of the commands' own, below this process's own. Removed by `remove_cgroup`.
class Cgroup {
 public:
  /// Fails with kInvalid, saying what the system does not allow.
  static Result<Cgroup> make();

  const std::string& path() const { return path_; }
  /// Puts the calling process into it, between fork and exec. False: not allowed.
  bool enter() const;

 private:
  explicit Cgroup(std::string path) : path_(std::move(path)) {}
  std::string path_;
};
/// Kills what is left in the cgroup at `path` and removes it; may be called again.
void remove_cgroup(const std::string& path);

Result<std::unique_ptr<Freezer>> make_cgroup_freezer(const Cgroup& cgroup);
/// SIGSTOP and SIGCONT for the commands' process groups, and for descendants that have left them,
/// but not for `guardian`. This process must be the reaper of its descendants and have one thread.
/// Fails with kInvalid on kernels that do not list a process's children.
Result<std::unique_ptr<Freezer>> make_signal_freezer(pid_t guardian);

}  // namespace tether::supervisor
