#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <vector>

#include <signal.h>
#include <sys/timerfd.h>
#include <sys/types.h>

#include <tether/base/time.h>

namespace tether::as_is {

/// The timers of the program, at ET. One that is a descriptor (timerfd) is a counter of the kernel
/// (eventfd), to which `fire` adds: whoever waits for it in the kernel wakes. The others send a
/// signal, or start a thread; their numbers are negative. Thread-safe.
class Timers {
 public:
  /// `start_thread`: for those with SIGEV_THREAD.
  using StartThread = void (*)(const sigevent&);
  explicit Timers(StartThread start_thread = nullptr) : start_thread_(start_thread) {}

  /// As timerfd_create(). @pre is_ours(clock)
  int create(clockid_t clock, int flags);
  /// As timer_create(): the number of a timer that notifies so.
  int create(clockid_t clock, const sigevent& event);
  bool is_ours(int fd) const;
  /// As timerfd_settime() and timerfd_gettime(). @pre is_ours(fd)
  int set(int fd, int flags, const itimerspec& value, itimerspec* old, ExecTime now);
  int get(int fd, itimerspec* value, ExecTime now);
  /// As read() of one that does not block. @pre is_ours(fd)
  ssize_t take(int fd, void* bytes, std::size_t size);
  /// As timer_getoverrun().
  int overrun(int number) const;
  void forget(int fd);
  void copy(int fd, int copy);

  /// Whether one that is no descriptor is set.
  bool have_events() const;
  /// When the first of them expires; none: none will.
  std::optional<ExecTime> next() const;
  /// Adds the expiries up to now. False: there were none.
  bool fire(ExecTime now);

 private:
  struct Timer {
    clockid_t clock;
    std::vector<int> fds;  // of the same counter
    std::optional<ExecTime> expiry{};
    Duration interval{0};             // 0: once
    std::optional<sigevent> event{};  // none: it is a descriptor
    int overrun = 0;

    itimerspec left(ExecTime now) const;
  };
  Timer* find(int fd);
  void notify(const sigevent& event, int overrun) const;
  void find_next();

  mutable std::mutex mutex_;
  std::vector<Timer> timers_;
  std::atomic<int> count_ = 0;
  StartThread start_thread_;
  int last_number_ = -1;  // of those that notify
  std::atomic<ExecTime> next_{ExecTime::max()};
};

}  // namespace tether::as_is
