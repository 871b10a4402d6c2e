#pragma once

#include <functional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace tether::supervisor {

/// A process as a look at it found it.
struct ProcessState {
  pid_t id = 0;
  pid_t parent = 0;
  pid_t group = 0;
  int running_threads = 0;          ///< neither stopped nor ended, nor:
  int uninterruptible_threads = 0;  ///< wait in the kernel for what no signal can hasten
};

/// Which of `processes` (parents before children) are at rest, in their order: all threads are
/// stopped or have ended, or wait for a stopped child to give back the memory that it shares with
/// them (vfork, posix_spawn), and cannot go on before it does.
std::vector<bool> at_rest(const std::vector<ProcessState>& processes,
                          const std::function<bool(pid_t, pid_t)>& share_memory);

/// Whether `child` has not yet begun a program of its own since `parent` started it.
bool share_memory(pid_t parent, pid_t child);

/// The processes that this one has started, and those that they have started, and so on. For this
/// process to stay the ancestor of them all it must be their reaper (PR_SET_CHILD_SUBREAPER).
class ProcessTree {
 public:
  /// `except`: a child of this process that is left out.
  explicit ProcessTree(pid_t except) : except_(except) {}

  /// False: the kernel does not list a process's children (CONFIG_PROC_CHILDREN).
  static bool is_listed();

  /// Parents before children; children of what is at rest here are complete.
  std::vector<ProcessState> look() const;
  /// Those of this process alone, in the same order.
  std::vector<pid_t> own_children() const;
  /// Kills all of them, and those that they start meanwhile, and waits until they have ended.
  void kill_all() const;

 private:
  void look_below(pid_t process, std::vector<ProcessState>& found) const;

  pid_t except_;
};

/// Kills all processes of the machine that were started with a variable in their environment that
/// begins with `beginning` ("NAME=VALUE"), wherever they belong.
void kill_all_with(const std::string& beginning);

}  // namespace tether::supervisor
