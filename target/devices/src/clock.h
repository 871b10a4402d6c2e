#pragma once

#include <tether/base/time.h>

namespace tether::devices {

/// The clock for waiting for devices and for timestamps. A parameter, so that tests do not sleep or
/// depend on the time at which they run.
class Clock {
 public:
  virtual ~Clock() = default;
  /// Since the origin of CLOCK_MONOTONIC, the clock of Video4Linux's timestamps.
  virtual Duration now() const = 0;
  /// Returns at once if `instant` is in the past.
  virtual void sleep_until(Duration instant) = 0;
};

class MonotonicClock final : public Clock {
 public:
  Duration now() const override;
  void sleep_until(Duration instant) override;
};

/// A rig's ET, which begins when the rig is opened. ST and ET are the same on real devices.
class Timeline {
 public:
  /// ET 0 is now. `clock` must outlive this.
  explicit Timeline(Clock& clock) : clock_(&clock), origin_(clock.now()) {}

  Clock& clock() const { return *clock_; }
  ExecTime now() const { return ExecTime(clock_->now() - origin_); }
  SimTime at(Duration monotonic) const { return SimTime(monotonic - origin_); }
  /// The clock's reading at `et`.
  Duration monotonic(ExecTime et) const { return et.time_since_epoch() + origin_; }

 private:
  Clock* clock_;
  Duration origin_;
};

}  // namespace tether::devices
