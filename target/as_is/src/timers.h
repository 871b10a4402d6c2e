#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <vector>

#include <sys/timerfd.h>
#include <sys/types.h>

#include <tether/base/time.h>

namespace tether::as_is {

/// The timers of the program that are descriptors (timerfd), at ET. Each is a counter of the kernel
/// (eventfd), to which `fire` adds: whoever waits for it in the kernel wakes. Thread-safe.
class Timers {
 public:
  /// As timerfd_create(). @pre is_ours(clock)
  int create(clockid_t clock, int flags);
  bool is_ours(int fd) const;
  /// As timerfd_settime() and timerfd_gettime(). @pre is_ours(fd)
  int set(int fd, int flags, const itimerspec& value, itimerspec* old, ExecTime now);
  int get(int fd, itimerspec* value, ExecTime now);
  /// As read() of one that does not block. @pre is_ours(fd)
  ssize_t take(int fd, void* bytes, std::size_t size);
  void forget(int fd);
  void copy(int fd, int copy);

  /// When the first of them expires; none: none will.
  std::optional<ExecTime> next() const;
  /// Adds the expiries up to now. False: there were none.
  bool fire(ExecTime now);

 private:
  struct Timer {
    clockid_t clock;
    std::vector<int> fds;  // of the same counter
    std::optional<ExecTime> expiry{};
    Duration interval{0};  // 0: once

    itimerspec left(ExecTime now) const;
  };
  Timer* find(int fd);
  void find_next();

  mutable std::mutex mutex_;
  std::vector<Timer> timers_;
  std::atomic<int> count_ = 0;
  std::atomic<ExecTime> next_{ExecTime::max()};
};

}  // namespace tether::as_is
