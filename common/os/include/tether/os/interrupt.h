#pragma once

#include <stop_token>
#include <thread>

#include <tether/os/pipe.h>

namespace tether::os {

/// SIGINT and SIGTERM as a request to stop, while it lives. One that comes more than half a second
/// after the first ends the process at once. Meanwhile SIGPIPE and SIGXFSZ are ignored, so that
/// what cannot be written is an error with a reason. One at a time.
class Interrupt {
 public:
  /// @throws Error(kSetup) when the system has neither a pipe nor a thread for it.
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  std::stop_token token() const { return stop_.get_token(); }

 private:
  void watch();

  Pipe signals_;  // a byte for each
  std::stop_source stop_;
  std::thread watcher_;
};

}  // namespace tether::os
