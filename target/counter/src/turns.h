#pragma once

#include "system_call.h"

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <mutex>
#include <vector>

#include <sys/types.h>

#include <tether/base/count_page.h>

namespace tether::counter {

/// Which thread of the emulated program computes. While the page is watched, it is one at a time:
/// a thread keeps its turn until a system call in which it may wait. The order is then the same in
/// each run, however the machine schedules them, so that threads that hand work to each other
/// compute and count the same. Two that could compute at the same time for longer than a hand-over
/// takes are a fault, and so is one that could while the program waits for a reply. After a fault
/// no thread is held up.
///
/// Every call is made by the thread that it is about, but for `begins`. Thread-safe.
class Turns {
 public:
  /// `page` must outlive it. A call that lasts longer than `longest_short_call` waits, whatever it
  /// is: it writes to a pipe that is full.
  explicit Turns(CountPage& page,
                 std::chrono::milliseconds longest_short_call = std::chrono::milliseconds(500))
      : page_(page), longest_short_call_(longest_short_call) {}

  /// A thread was started, by the one that computes. It computes until its first system call.
  void begins(unsigned thread);
  void enters_kernel(unsigned thread, SystemCall call);
  /// Returns when the thread may compute.
  void leaves_kernel(unsigned thread, std::int64_t result);

  /// Around a fork, so that the child can use its copy.
  std::mutex& mutex() { return mutex_; }

 private:
  using Clock = std::chrono::steady_clock;
  enum class State : std::uint8_t { kComputes, kStarts, kKeepsTurn, kInKernel, kQueues };
  struct Thread {
    State state = State::kComputes;
    SystemCall call = SystemCall::kShort;
    Clock::time_point entered{};
    std::uint64_t arrivals = 0;  // when the call began
  };
  using Lock = std::unique_lock<std::mutex>;

  bool is_watched() const;
  bool is_turn_of(unsigned thread);
  void queue(unsigned thread, Lock& lock);
  void wait_for_woken(const Thread& waker, std::int64_t count, Lock& lock);
  void wait_for_started(Lock& lock);
  void wait_for_ended(Lock& lock);
  void fail(CountFault fault);
  void fail_if_parallel(std::uint64_t since_units);
  void changed();

  int clock_readings_ = 0;  // since the program was held
  CountPage& page_;
  const std::chrono::milliseconds longest_short_call_;
  std::mutex mutex_;
  // Guarded by mutex_:
  std::condition_variable changed_;
  std::map<unsigned, Thread> threads_;
  std::vector<pid_t> ending_;
  unsigned last_ = 0;
  std::uint64_t arrivals_ = 0;  // of threads that queue
};

}  // namespace tether::counter
