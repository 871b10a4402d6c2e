#pragma once

#include <optional>

#include <sys/types.h>

#include <tether/base/time.h>

/// CPU time of all processes that this one has started, those that they have started, and so on.
namespace tether::client {

/// Of a process; none: it has ended, and was waited for.
std::optional<Duration> used_by_process(pid_t process);
/// That of the children for which this process has waited, and of those for which they had.
Duration used_by_waited_children();
/// Whether there are children for which it has not waited. One system call.
bool has_children();

struct LivingDescendants {
  Duration used{0};
  std::optional<pid_t> deaf;  ///< one that ignores SIGCHLD: its children's CPU time gets lost
};
/// That of all others, to be read after used_by_waited_children(): then none is in both. One that
/// is waited for meanwhile may be in neither.
///
/// The kernel knows another process's CPU time up to the last tick of its core, and that of the
/// children for which a living descendant has waited up to 20 ms.
LivingDescendants living_descendants();

/// This process ignores SIGCHLD, or has set SA_NOCLDWAIT: the CPU time of children that end gets
/// lost.
bool ignores_child_end();

}  // namespace tether::client
