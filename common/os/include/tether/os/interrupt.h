#pragma once

#include <atomic>
#include <chrono>
#include <optional>
#include <stop_token>
#include <thread>

#include <tether/base/time.h>
#include <tether/os/file_descriptor.h>

namespace tether::os {

/// Turns SIGINT, SIGTERM and SIGHUP (the terminal was closed) into a request to stop while it
/// lives. A second SIGINT or SIGTERM more than half a second after the first ends the process at
/// once, with the status 128 + signal and without its temporary folders. SIGHUP stays ignored if it
/// was (nohup). SIGPIPE and SIGXFSZ are ignored meanwhile, so that failed writes return an error.
/// One object at a time.
class Interrupt {
 public:
  /// @throws Error(kSetup) if a pipe or a thread cannot be created.
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  std::stop_token token() const { return stop_.get_token(); }

  /// Without its thread while this lives: a copy of a process with several threads may do little.
  /// Signals that arrive meanwhile are taken afterwards. If the thread cannot be started again,
  /// later signals end the process. Does nothing if there is no Interrupt.
  class Pause {
   public:
    Pause();
    ~Pause();
    Pause(const Pause&) = delete;
    Pause& operator=(const Pause&) = delete;

   private:
    Interrupt* paused_;
  };

  /// While this lives, the first signal ends the process at once: for a library that cannot be
  /// stopped, in a command that has written nothing. Does nothing if there is no Interrupt.
  class EndsAtOnce {
   public:
    EndsAtOnce();
    ~EndsAtOnce();
    EndsAtOnce(const EndsAtOnce&) = delete;
    EndsAtOnce& operator=(const EndsAtOnce&) = delete;

   private:
    Interrupt* interrupt_;
  };

 private:
  void start();
  void end_thread();
  void stop_catching() const;
  void watch();

  Pipe signals_;  // a byte for each
  bool ignores_hangup_ = false;
  std::stop_source stop_;
  std::atomic<bool> ends_at_once_ = false;
  std::optional<std::chrono::steady_clock::time_point> first_;  // signal
  std::thread watcher_;
};

/// Sleeps for that long, or until a stop is requested.
void sleep_unless_stopped(Duration limit, const std::stop_token& stop);

}  // namespace tether::os
