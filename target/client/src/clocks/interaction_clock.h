#pragma once

#include <optional>

#include <tether/base/time.h>

namespace tether::client {

/// What the policy of a run (barrier or free running) makes of a SUT's time. begin() → end()
/// bracket each call of the vehicle. Thread-safe.
class InteractionClock {
 public:
  virtual ~InteractionClock() = default;
  /// The SUT's own clock.
  virtual ExecTime now() const = 0;
  /// The SUT stops computing to talk to the UAV: the request's timestamp. A second call before
  /// end() changes nothing.
  virtual ExecTime begin() = 0;
  /// It goes on computing; `at` is the reply's timestamp, ≥ that of begin().
  virtual void end(ExecTime at) = 0;
  /// ET while the SUT computes; none while it waits for a reply (from begin() to end()).
  virtual std::optional<ExecTime> while_computing() const = 0;
};

}  // namespace tether::client
