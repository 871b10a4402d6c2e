#pragma once

#include <csignal>  // pid_t
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include <tether/base/time.h>

/// Processes of this machine, as the kernel shows them in /proc. Thread-safe.
namespace tether::os {

struct ProcessStat {
  char state = '?';  ///< 'R', 'S', 'T' …; 'Z': has ended, 'X': has ended and was waited for
  pid_t parent = 0;
  pid_t group = 0;
  Duration used{0};  ///< CPU time of its own threads, in ticks as the next
  /// CPU time of the children for which it has waited, and of those for which they had; rounded
  /// down to the kernel's ticks (10 ms), user and system time each.
  Duration waited_children{0};
  /// It ignores SIGCHLD: the CPU time of its children is lost when they end.
  bool ignores_child_end = false;
};

/// None: there is no such process.
std::optional<ProcessStat> process_stat(pid_t process);

/// All processes that this one can see.
std::vector<pid_t> all_processes();

/// The children of all threads of `process`, also those that have ended and were not waited for.
/// Children that appear or end meanwhile may be missing. Reads the whole process table on a kernel
/// that does not list them (CONFIG_PROC_CHILDREN).
std::vector<pid_t> children_of(pid_t process);

/// How many threads of a process and of its descendants do what, at one instant.
struct ThreadStates {
  int runnable = 0;           ///< run, or wait for a core
  int waiting = 0;            ///< on something that can take any time: a timer, a lock, a socket
  int halted = 0;             ///< by a signal or a debugger
  int on_disk = 0;            ///< wait until the disk, or memory that is on it, has answered
  int left_out_runnable = 0;  ///< as `runnable`, of the threads that are left out
};
/// Threads named `left_out` are not among the others; processes that have ended are not counted.
ThreadStates thread_states(pid_t process, std::string_view left_out = {});

/// How often the threads of a process and of its descendants have got a core so far. The same
/// number twice, and none runs or waits for a core or the disk in between: they were at rest.
std::uint64_t turns_of(pid_t process);

/// Whether `process` has a TCP connection between these ports, as its end sees them. False if this
/// process may not look.
bool has_connection(pid_t process, std::uint16_t local_port, std::uint16_t remote_port);

/// CPU time of this process and of all its descendants, living and ended. Short of that of some
/// descendants by a tick (10 ms).
Duration used_with_descendants();

/// From now on, descendants of this process whose own parent ends become its children, however
/// they left their group or session (PR_SET_CHILD_SUBREAPER).
void adopt_orphans();

}  // namespace tether::os
