#include "timers.h"

#include "clocks.h"
#include "real.h"

#include <algorithm>
#include <cerrno>
#include <climits>
#include <cstdint>
#include <utility>

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace tether::as_is {
namespace {

static_assert(int{TFD_NONBLOCK} == int{EFD_NONBLOCK} && int{TFD_CLOEXEC} == int{EFD_CLOEXEC});

int invalid() {
  errno = EINVAL;
  return -1;
}

/// What a counter has, which is 0 afterwards; as read() of one that does not block.
ssize_t take_count(int fd, void* bytes, std::size_t size) {
  pollfd counter{fd, POLLIN, 0};
  const timespec at_once{};
  if (size < sizeof(std::uint64_t) || TETHER_REAL(ppoll)(&counter, 1, &at_once, nullptr) != 0)
    return TETHER_REAL(read)(fd, bytes, size);
  errno = EAGAIN;
  return -1;
}

}  // namespace

itimerspec Timers::Timer::left(ExecTime now) const {
  return {to_timespec(interval), to_timespec(expiry ? *expiry - now : Duration(0))};
}

Timers::Timer* Timers::find(int fd) {
  const auto found = std::ranges::find_if(
      timers_, [fd](const Timer& timer) { return std::ranges::count(timer.fds, fd) > 0; });
  return found == timers_.end() ? nullptr : &*found;
}

void Timers::find_next() {
  ExecTime next = ExecTime::max();
  for (const Timer& timer : timers_) next = std::min(next, timer.expiry.value_or(next));
  next_ = next;
}

int Timers::create(clockid_t clock, int flags) {
  if ((flags & ~(TFD_NONBLOCK | TFD_CLOEXEC)) != 0) return invalid();
  const int fd = ::eventfd(0, flags);
  if (fd < 0) return fd;
  const std::lock_guard lock(mutex_);
  timers_.push_back({.clock = clock, .fds = {fd}});
  ++count_;
  return fd;
}

int Timers::create(clockid_t clock, const sigevent& event) {
  const std::lock_guard lock(mutex_);
  timers_.push_back({.clock = clock, .fds = {--last_number_}, .event = event});
  ++count_;
  return last_number_;
}

bool Timers::is_ours(int fd) const {
  if (count_ == 0) return false;
  const std::lock_guard lock(mutex_);
  return std::ranges::any_of(
      timers_, [fd](const Timer& timer) { return std::ranges::count(timer.fds, fd) > 0; });
}

int Timers::set(int fd, int flags, const itimerspec& value, itimerspec* old, ExecTime now) {
  const auto first = duration_of(value.it_value), interval = duration_of(value.it_interval);
  if (!first || !interval || (flags & ~(TFD_TIMER_ABSTIME | TFD_TIMER_CANCEL_ON_SET)) != 0)
    return invalid();
  fire(now);
  const std::lock_guard lock(mutex_);
  Timer* const timer = find(fd);
  if (timer == nullptr) return invalid();  // another thread has closed it
  if (old != nullptr) *old = timer->left(now);
  std::uint64_t dropped = 0;
  if (!timer->event) static_cast<void>(take_count(fd, &dropped, sizeof dropped));
  timer->interval = *interval;
  timer->expiry.reset();
  if (*first > Duration(0))
    timer->expiry =
        (flags & TFD_TIMER_ABSTIME) != 0 ? et_of(timer->clock, value.it_value) : now + *first;
  find_next();
  return 0;
}

int Timers::get(int fd, itimerspec* value, ExecTime now) {
  fire(now);
  const std::lock_guard lock(mutex_);
  const Timer* const timer = find(fd);
  if (timer == nullptr) return invalid();
  *value = timer->left(now);
  return 0;
}

// Under the lock, so that a thread that looked first does not wait for what another one took.
ssize_t Timers::take(int fd, void* bytes, std::size_t size) {
  const std::lock_guard lock(mutex_);
  return take_count(fd, bytes, size);
}

int Timers::overrun(int number) const {
  const std::lock_guard lock(mutex_);
  for (const Timer& timer : timers_)
    if (timer.fds.front() == number) return timer.overrun;
  return invalid();
}

void Timers::forget(int fd) {
  if (count_ == 0) return;
  const std::lock_guard lock(mutex_);
  Timer* const timer = find(fd);
  if (timer == nullptr) return;
  std::erase(timer->fds, fd);
  if (!timer->fds.empty()) return;
  timers_.erase(timers_.begin() + (timer - timers_.data()));
  --count_;
  find_next();
}

void Timers::copy(int fd, int copy) {
  if (count_ == 0) return;
  const std::lock_guard lock(mutex_);
  if (Timer* const timer = find(fd)) timer->fds.push_back(copy);
}

std::optional<ExecTime> Timers::next() const {
  const ExecTime next = next_;
  return next == ExecTime::max() ? std::nullopt : std::optional(next);
}

bool Timers::have_events() const {
  if (count_ == 0) return false;
  const std::lock_guard lock(mutex_);
  return std::ranges::any_of(timers_,
                             [](const Timer& timer) { return timer.event && timer.expiry; });
}

bool Timers::fire(ExecTime now) {
  if (next_.load() > now) return false;
  std::unique_lock lock(mutex_);
  bool is_any = false;
  std::vector<std::pair<sigevent, int>> events;
  for (Timer& timer : timers_) {
    if (!timer.expiry || *timer.expiry > now) continue;
    const std::int64_t more =
        timer.interval > Duration(0) ? (now - *timer.expiry) / timer.interval : 0;
    const std::uint64_t count = static_cast<std::uint64_t>(more) + 1;
    if (timer.interval > Duration(0))
      *timer.expiry += static_cast<std::int64_t>(count) * timer.interval;
    else
      timer.expiry.reset();
    is_any = true;
    if (timer.event) {
      timer.overrun = static_cast<int>(std::min<std::int64_t>(more, INT_MAX));
      events.emplace_back(*timer.event, timer.overrun);
    } else {
      static_cast<void>(TETHER_REAL(write)(timer.fds.front(), &count, sizeof count));
    }
  }
  find_next();
  lock.unlock();
  for (const auto& [event, overrun] : events) notify(event, overrun);
  return is_any;
}

// A handler may be called at once, and may set its timer.
void Timers::notify(const sigevent& event, int overrun) const {
  if (event.sigev_notify == SIGEV_THREAD && start_thread_ != nullptr) start_thread_(event);
  if (event.sigev_notify != SIGEV_SIGNAL && event.sigev_notify != SIGEV_THREAD_ID) return;
  siginfo_t info{};
  info.si_signo = event.sigev_signo;
  info.si_code = SI_TIMER;
  info.si_overrun = overrun;
  info.si_value = event.sigev_value;
  const pid_t process = ::getpid();
  if (event.sigev_notify == SIGEV_SIGNAL)
    TETHER_REAL(syscall)(SYS_rt_sigqueueinfo, process, event.sigev_signo, &info);
  else
    TETHER_REAL(syscall)
  (SYS_rt_tgsigqueueinfo, process, event._sigev_un._tid, event.sigev_signo, &info);
}

}  // namespace tether::as_is
