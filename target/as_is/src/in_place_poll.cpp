// Waits for several descriptors in place of the C library's. All have one form: look at once; then
// wait by the agent, which looks again after each message; while other threads compute, wait in
// real time in between.

#include "clocks.h"
#include "in_place.h"

#include <algorithm>
#include <cerrno>
#include <optional>
#include <vector>

#include <poll.h>
#include <sys/epoll.h>
#include <sys/select.h>

namespace tether::as_is {
namespace {

constexpr std::int64_t kNsPerMs = 1'000'000;

std::optional<ExecTime> deadline_of(const Agent& agent, std::optional<Duration> timeout) {
  if (!timeout) return std::nullopt;
  return agent.now() + *timeout;
}

/// `look()`: the real call, without waiting; `block` waits for the same. The result, or 0 after the
/// timeout.
template <class Look>
int wait_for(Agent& agent, std::optional<Duration> timeout, Look look, const Agent::Block& block) {
  const int kept = errno;
  const Inside inside;
  agent.fire_timers();
  int result = look();
  if (result == 0 && timeout == Duration(0)) {
    if (agent.is_fed()) agent.take_arrived();
    result = look();
  } else if (result == 0) {
    const auto end = agent.wait(
        deadline_of(agent, timeout), [&] { return (result = look()) != 0; }, block);
    if (end == Agent::End::kHandler) {
      errno = EINTR;
      return -1;
    }
  }
  if (result >= 0) errno = kept;
  return result;
}

std::optional<Duration> of_ms(int timeout_ms) {
  if (timeout_ms < 0) return std::nullopt;
  return Duration(timeout_ms * kNsPerMs);
}

/// False: it is no duration.
bool read_timeout(const timespec* time, std::optional<Duration>& timeout) {
  timeout = time == nullptr ? std::nullopt : duration_of(*time);
  return time == nullptr || timeout;
}

struct Sets {
  fd_set* given[3];
  fd_set wanted[3]{};

  Sets(fd_set* read, fd_set* write, fd_set* except) : given{read, write, except} {
    for (int i = 0; i < 3; ++i)
      if (given[i] != nullptr) wanted[i] = *given[i];
  }
  fd_set* again(int i) {
    if (given[i] != nullptr) *given[i] = wanted[i];
    return given[i];
  }
};

constexpr timespec kAtOnce{};

int select_for(Agent& agent, int count, Sets sets, std::optional<Duration> timeout,
               const sigset_t* mask) {
  return wait_for(
      agent, timeout,
      [&] {
        return TETHER_REAL(pselect)(count, sets.again(0), sets.again(1), sets.again(2), &kAtOnce,
                                    mask);
      },
      [&](Duration slice, int wake) {
        const timespec time = to_timespec(slice);
        Sets with_wake = sets;
        auto& [read, write, except] = with_wake.wanted;
        if (wake < FD_SETSIZE) FD_SET(wake, &read);
        TETHER_REAL(pselect)(std::max(count, wake + 1), &read, &write, &except, &time, mask);
      });
}

int poll_for(Agent& agent, pollfd* fds, nfds_t count, std::optional<Duration> timeout,
             const sigset_t* mask) {
  std::vector<pollfd> with_wake;
  return wait_for(
      agent, timeout, [&] { return TETHER_REAL(ppoll)(fds, count, &kAtOnce, mask); },
      [&](Duration slice, int wake) {
        const timespec time = to_timespec(slice);
        with_wake.assign(fds, fds + count);
        with_wake.push_back({wake, POLLIN, 0});
        TETHER_REAL(ppoll)(with_wake.data(), with_wake.size(), &time, mask);
      });
}

int epoll_for(Agent& agent, int epoll, epoll_event* events, int most,
              std::optional<Duration> timeout, const sigset_t* mask) {
  return wait_for(
      agent, timeout, [&] { return TETHER_REAL(epoll_pwait)(epoll, events, most, 0, mask); },
      [&](Duration slice, int wake) {
        const timespec time = to_timespec(slice);
        pollfd fds[] = {{epoll, POLLIN, 0}, {wake, POLLIN, 0}};
        TETHER_REAL(ppoll)(fds, 2, &time, mask);
      });
}

int invalid() {
  errno = EINVAL;
  return -1;
}

}  // namespace
}  // namespace tether::as_is

using namespace tether::as_is;
using tether::Duration;

TETHER_IN_PLACE int poll(pollfd* fds, nfds_t count, int timeout_ms) {
  Agent* const agent = tether::as_is::agent();
  if (agent == nullptr) return TETHER_REAL(poll)(fds, count, timeout_ms);
  return poll_for(*agent, fds, count, of_ms(timeout_ms), nullptr);
}

TETHER_IN_PLACE int ppoll(pollfd* fds, nfds_t count, const timespec* time, const sigset_t* mask) {
  Agent* const agent = tether::as_is::agent();
  if (agent == nullptr) return TETHER_REAL(ppoll)(fds, count, time, mask);
  std::optional<Duration> timeout;
  return read_timeout(time, timeout) ? poll_for(*agent, fds, count, timeout, mask) : invalid();
}

TETHER_IN_PLACE int __poll_chk(pollfd* fds, nfds_t count, int timeout_ms, std::size_t) {
  return poll(fds, count, timeout_ms);
}

TETHER_IN_PLACE int __ppoll_chk(pollfd* fds, nfds_t count, const timespec* time,
                                const sigset_t* mask, std::size_t) {
  return ppoll(fds, count, time, mask);
}

TETHER_IN_PLACE int select(int count, fd_set* __restrict read, fd_set* __restrict write,
                           fd_set* __restrict except, timeval* __restrict time) {
  Agent* const agent = tether::as_is::agent();
  if (agent == nullptr) return TETHER_REAL(select)(count, read, write, except, time);
  std::optional<Duration> timeout;
  if (time != nullptr) {
    const timespec precise{time->tv_sec, time->tv_usec * 1000};
    if (!read_timeout(&precise, timeout)) return invalid();
  }
  return select_for(*agent, count, {read, write, except}, timeout, nullptr);
}

TETHER_IN_PLACE int pselect(int count, fd_set* __restrict read, fd_set* __restrict write,
                            fd_set* __restrict except, const timespec* __restrict time,
                            const sigset_t* __restrict mask) {
  Agent* const agent = tether::as_is::agent();
  if (agent == nullptr) return TETHER_REAL(pselect)(count, read, write, except, time, mask);
  std::optional<Duration> timeout;
  if (!read_timeout(time, timeout)) return invalid();
  return select_for(*agent, count, {read, write, except}, timeout, mask);
}

TETHER_IN_PLACE int epoll_pwait(int epoll, epoll_event* events, int most, int timeout_ms,
                                const sigset_t* mask) {
  Agent* const agent = tether::as_is::agent();
  if (agent == nullptr) return TETHER_REAL(epoll_pwait)(epoll, events, most, timeout_ms, mask);
  return epoll_for(*agent, epoll, events, most, of_ms(timeout_ms), mask);
}

TETHER_IN_PLACE int epoll_wait(int epoll, epoll_event* events, int most, int timeout_ms) {
  return epoll_pwait(epoll, events, most, timeout_ms, nullptr);
}

TETHER_IN_PLACE int epoll_pwait2(int epoll, epoll_event* events, int most, const timespec* time,
                                 const sigset_t* mask) {
  Agent* const agent = tether::as_is::agent();
  if (agent == nullptr) return TETHER_REAL(epoll_pwait2)(epoll, events, most, time, mask);
  std::optional<Duration> timeout;
  return read_timeout(time, timeout) ? epoll_for(*agent, epoll, events, most, timeout, mask)
                                     : invalid();
}
