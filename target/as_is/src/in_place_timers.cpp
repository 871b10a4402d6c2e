// Timers in place of the C library's. Those that are descriptors are at ET; those that send signals
// are the real ones, told once.

#include "clocks.h"
#include "in_place.h"

#include <cerrno>
#include <csignal>
#include <ctime>

#include <sys/time.h>
#include <sys/timerfd.h>
#include <unistd.h>

namespace tether::as_is {
namespace {

void tell(const char* what) {
  Agent* const agent = tether::as_is::agent();
  if (agent == nullptr) return;
  const Inside inside;
  agent->tell_gap(what);
}

/// The agent, if the timer is one of its own.
Agent* agent_of_timer(int fd) {
  Agent* const agent = tether::as_is::agent();
  return agent != nullptr && agent->timers().is_ours(fd) ? agent : nullptr;
}

}  // namespace
}  // namespace tether::as_is

using namespace tether::as_is;

TETHER_IN_PLACE int timerfd_create(clockid_t clock, int flags) {
  Agent* const agent = tether::as_is::agent();
  if (agent == nullptr || !is_ours(clock)) {
    tell("timerfd_create");
    return TETHER_REAL(timerfd_create)(clock, flags);
  }
  const Inside inside;
  return agent->timers().create(clock, flags);
}

TETHER_IN_PLACE int timerfd_settime(int fd, int flags, const itimerspec* value, itimerspec* old) {
  Agent* const agent = agent_of_timer(fd);
  if (agent == nullptr) return TETHER_REAL(timerfd_settime)(fd, flags, value, old);
  const int kept = errno;
  const Inside inside;
  const int result = agent->timers().set(fd, flags, *value, old, agent->now());
  agent->tell_needs();
  if (result == 0) errno = kept;
  return result;
}

TETHER_IN_PLACE int timerfd_gettime(int fd, itimerspec* value) {
  Agent* const agent = agent_of_timer(fd);
  if (agent == nullptr) return TETHER_REAL(timerfd_gettime)(fd, value);
  const Inside inside;
  return agent->timers().get(fd, value, agent->now());
}

TETHER_IN_PLACE int timer_create(clockid_t clock, sigevent* __restrict event,
                                 timer_t* __restrict timer) {
  tell("timer_create");
  return TETHER_REAL(timer_create)(clock, event, timer);
}

TETHER_IN_PLACE int setitimer(__itimer_which_t which, const itimerval* __restrict value,
                              itimerval* __restrict old) {
  if (which == ITIMER_REAL) tell("setitimer");
  return TETHER_REAL(setitimer)(which, value, old);
}

TETHER_IN_PLACE unsigned alarm(unsigned seconds) {
  if (seconds > 0) tell("alarm");
  return TETHER_REAL(alarm)(seconds);
}
