#include "turns.h"

#include <algorithm>

#include <sys/syscall.h>
#include <unistd.h>

namespace tether::counter {
namespace {

// What one thread may compute while another one could: between waking it and waiting.
constexpr std::uint64_t kHandOver_units = 100'000 * static_cast<std::uint64_t>(kCostUnitsPerNs);
// How often a program may ask for the machine's time between two calls of the vehicle: for logs,
// and to measure itself. One that waits by that clock does so some thousand times in a millisecond.
constexpr int kMostClockReadings = 1000;
// How long a thread that was woken may take to return, on a machine with other load.
constexpr std::chrono::seconds kLongestWaking{5};
constexpr std::chrono::milliseconds kLook{1};
// Until a thread that ends is gone.
constexpr std::chrono::microseconds kLookAtEnd{50};

bool exists(pid_t thread) {
  return ::syscall(SYS_tgkill, ::getpid(), thread, 0) == 0;
}

}  // namespace

bool Turns::is_watched() const {
  return page_.watched.load() != 0 && page_.fault.load() == 0;
}

void Turns::fail(CountFault fault) {
  std::uint32_t none = 0;
  page_.fault.compare_exchange_strong(none, static_cast<std::uint32_t>(fault));
}

void Turns::fail_if_parallel(std::uint64_t since_units) {
  if (page_.units.load() - since_units > kHandOver_units) fail(CountFault::kThreads);
}

void Turns::changed() {
  const auto computing = std::count_if(threads_.begin(), threads_.end(), [](const auto& entry) {
    return entry.second.state != State::kInKernel;
  });
  page_.computing.store(static_cast<std::uint32_t>(computing));
  changed_.notify_all();
}

void Turns::begins(unsigned thread) {
  const Lock lock(mutex_);
  threads_[thread].state = is_watched() ? State::kStarts : State::kComputes;
  changed();
}

void Turns::enters_kernel(unsigned thread, SystemCall call) {
  const Lock lock(mutex_);
  Thread& own = threads_[thread];
  const bool is_new = own.state == State::kStarts;
  if (is_watched()) {
    for (const auto& [other, state] : threads_)
      if (other != thread && !is_new && state.state == State::kComputes) fail(CountFault::kThreads);
    if (call == SystemCall::kStartsProcess) fail(CountFault::kProcess);
    if (page_.held.load() != 0) clock_readings_ = 0;
    if (call == SystemCall::kReadsClock && ++clock_readings_ > kMostClockReadings)
      fail(CountFault::kClock);
  }
  const bool keeps = is_watched() && !is_new && call != SystemCall::kWaits;
  own = {keeps ? State::kKeepsTurn : State::kInKernel, call, Clock::now(), arrivals_};
  if (!is_new) last_ = thread;
  if (call == SystemCall::kEndsThread) {
    threads_.erase(thread);
    ending_.push_back(static_cast<pid_t>(::syscall(SYS_gettid)));
  }
  changed();
}

void Turns::leaves_kernel(unsigned thread, std::int64_t result) {
  Lock lock(mutex_);
  Thread& own = threads_[thread];
  if (own.state == State::kInKernel && is_watched()) queue(thread, lock);
  own.state = State::kComputes;
  changed();
  if (!is_watched()) return;
  if (own.call == SystemCall::kWakes) wait_for_woken(own, result, lock);
  if (own.call == SystemCall::kStartsThread) wait_for_started(lock);
}

bool Turns::is_turn_of(unsigned thread) {
  bool is_free = true;
  for (auto& [other, state] : threads_) {
    if (other == thread || state.state == State::kInKernel) continue;
    const bool lasts = Clock::now() - state.entered > longest_short_call_;
    if (state.state == State::kKeepsTurn && lasts)
      state.state = State::kInKernel;
    else if (state.state != State::kQueues || other < thread)
      is_free = false;
  }
  return is_free;
}

void Turns::queue(unsigned thread, Lock& lock) {
  threads_[thread].state = State::kQueues;
  ++arrivals_;
  changed();
  const std::uint64_t since_units = page_.units.load();
  while (is_watched() && !is_turn_of(thread)) {
    changed_.wait_for(lock, kLook);
    fail_if_parallel(since_units);
  }
  fail_if_parallel(since_units);
  if (page_.held.load() != 0 && thread != last_) fail(CountFault::kThreads);
  wait_for_ended(lock);
}

// Then it is known what is in the queue when this thread lets go of its turn.
void Turns::wait_for_woken(const Thread& waker, std::int64_t count, Lock& lock) {
  const auto end = Clock::now() + kLongestWaking;
  const auto has_arrived = [&] {
    return static_cast<std::int64_t>(arrivals_ - waker.arrivals) >= count;
  };
  while (is_watched() && !has_arrived() && Clock::now() < end) changed_.wait_for(lock, kLook);
}

void Turns::wait_for_started(Lock& lock) {
  const std::uint64_t since_units = page_.units.load();
  const auto starts = [](const auto& entry) { return entry.second.state == State::kStarts; };
  while (is_watched() && std::any_of(threads_.begin(), threads_.end(), starts)) {
    changed_.wait_for(lock, kLook);
    fail_if_parallel(since_units);
  }
}

// A thread that joins another one finds that it has ended, or waits for it: which, must not depend
// on how long the emulator takes to end it.
void Turns::wait_for_ended(Lock& lock) {
  while (is_watched() && !ending_.empty()) {
    std::erase_if(ending_, [](pid_t thread) { return !exists(thread); });
    if (!ending_.empty()) changed_.wait_for(lock, kLookAtEnd);
  }
}

}  // namespace tether::counter
