#pragma once

#include <optional>
#include <vector>

#include <sys/types.h>

namespace tether::exec {

/// The processes that this one has started, and those that they have started, and so on. For this
/// process to stay the ancestor of them all it must be their reaper (PR_SET_CHILD_SUBREAPER).
class ProcessTree {
 public:
  /// False: the kernel does not list a process's children (CONFIG_PROC_CHILDREN).
  static bool is_listed();

  /// Whether every thread of every descendant in process group `group` is stopped or has ended.
  bool all_stopped(pid_t group);

 private:
  bool stopped_below(pid_t process, pid_t group);
};

}  // namespace tether::exec
