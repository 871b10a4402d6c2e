// Clocks and sleeps in place of the C library's.

#include "clocks.h"
#include "in_place.h"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <sys/syscall.h>
#include <sys/time.h>
#include <unistd.h>

namespace tether::as_is {
namespace {

int sleep_for(Agent& agent, const timespec* duration, timespec* left) {
  const auto wanted = duration_of(*duration);
  if (!wanted) return EINVAL;
  const Inside inside;
  const KeepErrno keep;
  const tether::ExecTime until = agent.now() + *wanted;
  if (agent.sleep_until(until)) return 0;
  if (left != nullptr) *left = to_timespec(std::max(until - agent.now(), Duration(0)));
  return EINTR;
}

}  // namespace
}  // namespace tether::as_is

using namespace tether::as_is;

TETHER_IN_PLACE int clock_gettime(clockid_t clock, timespec* time) {
  Agent* const agent = tether::as_is::agent();
  if (agent == nullptr || !is_ours(clock)) return TETHER_REAL(clock_gettime)(clock, time);
  const Inside inside;
  const KeepErrno keep;
  *time = shown(clock, agent->now());
  return 0;
}

TETHER_IN_PLACE int gettimeofday(timeval* __restrict time, void* __restrict zone) {
  Agent* const agent = tether::as_is::agent();
  if (agent == nullptr) return TETHER_REAL(gettimeofday)(time, zone);
  const Inside inside;
  const KeepErrno keep;
  const timespec now = shown(CLOCK_REALTIME, agent->now());
  *time = {now.tv_sec, now.tv_nsec / 1000};
  return 0;
}

TETHER_IN_PLACE time_t time(time_t* out) {
  Agent* const agent = tether::as_is::agent();
  if (agent == nullptr) return TETHER_REAL(time)(out);
  const Inside inside;
  const KeepErrno keep;
  const time_t now = shown(CLOCK_REALTIME, agent->now()).tv_sec;
  if (out != nullptr) *out = now;
  return now;
}

TETHER_IN_PLACE int nanosleep(const timespec* duration, timespec* left) {
  Agent* const agent = tether::as_is::agent();
  if (agent == nullptr) return TETHER_REAL(nanosleep)(duration, left);
  const int wrong = sleep_for(*agent, duration, left);
  if (wrong == 0) return 0;
  errno = wrong;
  return -1;
}

TETHER_IN_PLACE int clock_nanosleep(clockid_t clock, int flags, const timespec* until,
                                    timespec* left) {
  Agent* const agent = tether::as_is::agent();
  if (agent == nullptr || !is_ours(clock))
    return TETHER_REAL(clock_nanosleep)(clock, flags, until, left);
  if ((flags & TIMER_ABSTIME) == 0) return sleep_for(*agent, until, left);
  if (!duration_of(*until)) return EINVAL;
  const Inside inside;
  const KeepErrno keep;
  return agent->sleep_until(et_of(clock, *until)) ? 0 : EINTR;
}

// The C library's own functions of C11 do not call those above.
TETHER_IN_PLACE int timespec_get(timespec* time, int base) {
  return base == TIME_UTC && clock_gettime(CLOCK_REALTIME, time) == 0 ? base : 0;
}

TETHER_IN_PLACE int thrd_sleep(const timespec* duration, timespec* left) {
  if (nanosleep(duration, left) == 0) return 0;
  return errno == EINTR ? -1 : -2;
}

TETHER_IN_PLACE int usleep(useconds_t duration_us) {
  if (agent() == nullptr) return TETHER_REAL(usleep)(duration_us);
  const timespec time = to_timespec(std::chrono::microseconds(duration_us));
  return nanosleep(&time, nullptr);
}

TETHER_IN_PLACE unsigned sleep(unsigned duration_s) {
  if (agent() == nullptr) return TETHER_REAL(sleep)(duration_s);
  const timespec time{static_cast<time_t>(duration_s), 0};
  timespec left{};
  const bool is_over = nanosleep(&time, &left) == 0;
  return is_over ? 0 : static_cast<unsigned>(left.tv_sec) + (left.tv_nsec > 0 ? 1U : 0U);
}

namespace tether::as_is {
namespace {

template <class T>
T* pointer(long argument) {
  T* result = nullptr;
  std::memcpy(static_cast<void*>(&result), &argument, sizeof argument);
  return result;
}

}  // namespace

std::optional<long> time_call(long number, const long (&a)[6]) {
  if (agent() == nullptr) return std::nullopt;
  const auto clock = static_cast<clockid_t>(a[0]);
  switch (number) {
    case SYS_clock_gettime:
      return ::clock_gettime(clock, pointer<timespec>(a[1]));
    case SYS_gettimeofday:
      return ::gettimeofday(pointer<timeval>(a[0]), pointer<void>(a[1]));
#ifdef SYS_time
    case SYS_time:
      return ::time(pointer<time_t>(a[0]));
#endif
    case SYS_nanosleep:
      return ::nanosleep(pointer<timespec>(a[0]), pointer<timespec>(a[1]));
    case SYS_clock_nanosleep: {
      const int wrong = ::clock_nanosleep(clock, static_cast<int>(a[1]), pointer<timespec>(a[2]),
                                          pointer<timespec>(a[3]));
      if (wrong != 0) errno = wrong;
      return wrong == 0 ? 0 : -1;
    }
    default:
      return std::nullopt;
  }
}

}  // namespace tether::as_is
