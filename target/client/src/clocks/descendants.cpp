#include "clocks/descendants.h"

#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <tether/os/process_table.h>

namespace tether::client {
namespace {

Duration duration_of(const timeval& t) {
  return std::chrono::seconds(t.tv_sec) + std::chrono::microseconds(t.tv_usec);
}

// What a process knows of those for which it has waited is read before its living children. The
// kernel marks a child ('X') before it adds the child's CPU time to the parent's.
void add_below(pid_t process, LivingDescendants& sum) {
  for (const pid_t child : os::children_of(process)) {
    const auto used = used_by_process(child);
    const auto stat = os::process_stat(child);
    if (!used || !stat || stat->state == 'X') continue;
    sum.used += *used + stat->waited_children;
    if (stat->ignores_child_end) sum.deaf = child;
    add_below(child, sum);
  }
}

}  // namespace

// The number of its clock is as clock_getcpuclockid() makes it, without asking whether it exists.
std::optional<Duration> used_by_process(pid_t process) {
  constexpr unsigned kScheduled = 2;
  const auto clock = static_cast<clockid_t>((~static_cast<unsigned>(process) << 3) | kScheduled);
  timespec t{};
  if (::clock_gettime(clock, &t) != 0) return std::nullopt;
  return std::chrono::seconds(t.tv_sec) + Duration(t.tv_nsec);
}

Duration used_by_waited_children() {
  rusage used{};
  ::getrusage(RUSAGE_CHILDREN, &used);
  return duration_of(used.ru_utime) + duration_of(used.ru_stime);
}

bool has_children() {
  siginfo_t ignored{};
  return ::waitid(P_ALL, 0, &ignored, WEXITED | WNOHANG | WNOWAIT | __WALL) == 0;
}

LivingDescendants living_descendants() {
  LivingDescendants sum;
  add_below(::getpid(), sum);
  return sum;
}

bool ignores_child_end() {
  struct sigaction action {};
  ::sigaction(SIGCHLD, nullptr, &action);
  return action.sa_handler == SIG_IGN || (action.sa_flags & SA_NOCLDWAIT) != 0;
}

}  // namespace tether::client
