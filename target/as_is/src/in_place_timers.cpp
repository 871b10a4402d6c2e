// Timers in place of the C library's: those that are descriptors, and those that send signals.

#include "clocks.h"
#include "in_place.h"

#include <bit>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdint>
#include <ctime>
#include <mutex>
#include <utility>

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

int set(Agent& agent, int timer, int flags, const itimerspec& value, itimerspec* old) {
  const int kept = errno;
  const Inside inside;
  const int result = agent.timers().set(timer, flags, value, old, agent.now());
  agent.tell_needs();
  if (result == 0) errno = kept;
  return result;
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
  return set(*agent, fd, flags, *value, old);
}

TETHER_IN_PLACE int timerfd_gettime(int fd, itimerspec* value) {
  Agent* const agent = agent_of_timer(fd);
  if (agent == nullptr) return TETHER_REAL(timerfd_gettime)(fd, value);
  const Inside inside;
  return agent->timers().get(fd, value, agent->now());
}

namespace tether::as_is {
namespace {

/// Those that the library does not count have numbers of their own, and no negative ones.
int number_of(timer_t timer) {
  const auto whole = std::bit_cast<std::intptr_t>(timer);
  return whole < 0 && whole > INT_MIN ? static_cast<int>(whole) : 0;
}

/// The agent, if it has the timer of timer_create().
Agent* agent_of(timer_t timer) {
  return number_of(timer) == 0 ? nullptr : tether::as_is::agent();
}

/// The one of alarm() and setitimer().
int alarm_of(Agent& agent) {
  sigevent event{};
  event.sigev_notify = SIGEV_SIGNAL;
  event.sigev_signo = SIGALRM;
  static std::mutex mutex;
  static pid_t process = 0;  // a child that was forked has none
  static int number = 0;
  const Inside inside;
  const std::lock_guard lock(mutex);
  if (std::exchange(process, ::getpid()) != ::getpid() || number == 0)
    number = agent.timers().create(CLOCK_MONOTONIC, event);
  return number;
}

timeval to_timeval(const timespec& time) {
  return {time.tv_sec, (time.tv_nsec + 999) / 1000};
}
itimerval to_itimerval(const itimerspec& value) {
  return {to_timeval(value.it_interval), to_timeval(value.it_value)};
}
timespec of_timeval(const timeval& time) {
  return {time.tv_sec, time.tv_usec * 1000};
}

}  // namespace
}  // namespace tether::as_is

TETHER_IN_PLACE int timer_create(clockid_t clock, sigevent* __restrict event,
                                 timer_t* __restrict timer) {
  Agent* const agent = tether::as_is::agent();
  if (agent == nullptr || !is_ours(clock)) return TETHER_REAL(timer_create)(clock, event, timer);
  sigevent own{};
  own.sigev_notify = SIGEV_SIGNAL;
  own.sigev_signo = SIGALRM;
  if (event != nullptr) own = *event;
  const Inside inside;
  const int number = agent->timers().create(clock, own);
  *timer = std::bit_cast<timer_t>(static_cast<std::intptr_t>(number));
  return 0;
}

TETHER_IN_PLACE int timer_settime(timer_t timer, int flags, const itimerspec* __restrict value,
                                  itimerspec* __restrict old) {
  Agent* const agent = agent_of(timer);
  if (agent == nullptr) return TETHER_REAL(timer_settime)(timer, flags, value, old);
  static_assert(int{TIMER_ABSTIME} == int{TFD_TIMER_ABSTIME});
  return set(*agent, number_of(timer), flags, *value, old);
}

TETHER_IN_PLACE int timer_gettime(timer_t timer, itimerspec* value) {
  Agent* const agent = agent_of(timer);
  if (agent == nullptr) return TETHER_REAL(timer_gettime)(timer, value);
  const Inside inside;
  return agent->timers().get(number_of(timer), value, agent->now());
}

TETHER_IN_PLACE int timer_getoverrun(timer_t timer) {
  Agent* const agent = agent_of(timer);
  if (agent == nullptr) return TETHER_REAL(timer_getoverrun)(timer);
  const Inside inside;
  return agent->timers().overrun(number_of(timer));
}

TETHER_IN_PLACE int timer_delete(timer_t timer) {
  Agent* const agent = agent_of(timer);
  if (agent == nullptr) return TETHER_REAL(timer_delete)(timer);
  const Inside inside;
  agent->timers().forget(number_of(timer));
  return 0;
}

TETHER_IN_PLACE int setitimer(__itimer_which_t which, const itimerval* __restrict value,
                              itimerval* __restrict old) {
  Agent* const agent = tether::as_is::agent();
  if (agent == nullptr || which != ITIMER_REAL) return TETHER_REAL(setitimer)(which, value, old);
  const itimerval wanted = value == nullptr ? itimerval{} : *value;
  itimerspec before{};
  const int result = set(*agent, alarm_of(*agent), 0,
                         {of_timeval(wanted.it_interval), of_timeval(wanted.it_value)}, &before);
  if (result == 0 && old != nullptr) *old = to_itimerval(before);
  return result;
}

TETHER_IN_PLACE int getitimer(__itimer_which_t which, itimerval* value) {
  Agent* const agent = tether::as_is::agent();
  if (agent == nullptr || which != ITIMER_REAL) return TETHER_REAL(getitimer)(which, value);
  const int alarm = alarm_of(*agent);
  const Inside inside;
  itimerspec now{};
  const int result = agent->timers().get(alarm, &now, agent->now());
  *value = to_itimerval(now);
  return result;
}

TETHER_IN_PLACE unsigned alarm(unsigned seconds) {
  if (agent() == nullptr) return TETHER_REAL(alarm)(seconds);
  const itimerval value{{}, {static_cast<time_t>(seconds), 0}};
  itimerval old{};
  setitimer(ITIMER_REAL, &value, &old);
  constexpr long kHalf_us = 500'000;
  const auto left = static_cast<unsigned>(old.it_value.tv_sec);
  const bool rounds_up =
      old.it_value.tv_usec >= kHalf_us || (left == 0 && old.it_value.tv_usec > 0);
  return left + (rounds_up ? 1U : 0U);
}
