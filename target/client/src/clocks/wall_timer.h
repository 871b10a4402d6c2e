#pragma once

#include <memory>

#include <tether/base/time.h>

namespace tether::client {

/// This machine's wall clock, and waiting on it. An interface, so that tests need not wait.
class WallTimer {
 public:
  virtual ~WallTimer() = default;
  /// Since an origin of its own; monotone.
  virtual Duration now() const = 0;
  /// Returns at once if that is past.
  virtual void sleep_until(Duration instant) = 0;
};

std::unique_ptr<WallTimer> make_wall_timer();

}  // namespace tether::client
