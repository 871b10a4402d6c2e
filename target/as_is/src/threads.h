#pragma once

#include <atomic>
#include <cstdint>

#include <signal.h>
#include <sys/types.h>

#include <tether/client/exec/computed.h>

namespace tether::as_is {

/// Starts a thread of the program that calls the function of a timer with SIGEV_THREAD.
void start_thread(const sigevent& event);

/// The threads of this process: whether all but the calling one wait.
class Threads {
 public:
  /// Whether no other thread of the program, and no child, runs or could. Looks at the kernel's
  /// states of all of them, twice, unless there is one only.
  bool are_others_waiting();

  /// While one lives, the calling thread waits for somebody outside, in real time: ET does not go
  /// on without it.
  class Outside {
   public:
    Outside() { ++outside_; }
    ~Outside() { --outside_; }
    Outside(const Outside&) = delete;
    Outside& operator=(const Outside&) = delete;
  };

  /// A thread of the program begins, or ends.
  static void began() { ++count_; }
  static void ended() { --count_; }
  /// What those that are there have computed, by their names.
  static client::Computed computed();
  static bool are_several() { return count_.load() > 1; }

 private:
  static std::atomic<int> count_;
  static std::atomic<int> outside_;
};

}  // namespace tether::as_is
