// Timers that the kernel keeps, which are not brought to ET: the real ones, told once.

#include "in_place.h"

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

}  // namespace
}  // namespace tether::as_is

using tether::as_is::tell;

TETHER_IN_PLACE int timerfd_create(clockid_t clock, int flags) {
  tell("timerfd_create");
  return TETHER_REAL(timerfd_create)(clock, flags);
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
