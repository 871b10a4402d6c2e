#pragma once

#include <memory>

#include <tether/base/time.h>
#include <tether/link/messages.h>

namespace tether::client {

/// Where a SUT's execution time comes from (DESIGN section 2, "How a SUT's time is measured").
/// Monotone.
class TimeSource {
 public:
  virtual ~TimeSource() = default;
  virtual link::ClockKind kind() const = 0;
  /// Seconds of ET per second of what is measured; 1 except for a virtual target.
  virtual double factor() const { return 1.0; }
  /// Time measured since an origin of its own, already scaled by `factor()`. Thread-safe.
  virtual Duration elapsed() const = 0;
};

/// The machine's monotonic clock.
std::unique_ptr<TimeSource> make_wall_source();
/// CPU time of this process × factor: a virtual target. @pre factor > 0.
std::unique_ptr<TimeSource> make_cpu_source(double factor);

/// ET of this SUT: runs with its source while the SUT is free, stands still while it is held, and
/// goes on from exactly the timestamp it is given (DESIGN section 2, rules 5 and 6).
///
/// hold() → resume(t_rep) bracket each interaction. Not thread-safe; `source` must outlive it.
class SutClock {
 public:
  explicit SutClock(const TimeSource& source, ExecTime start = ExecTime{});

  /// ET now.
  ExecTime now() const;
  /// Stops the clock and returns ET: the request's stamp. Idempotent while held.
  ExecTime hold();
  /// Starts it again with ET = `at`. @pre held, at ≥ the value that hold() returned.
  void resume(ExecTime at);
  bool is_held() const { return held_; }

 private:
  const TimeSource* source_;
  ExecTime base_et_;
  Duration base_source_;
  bool held_ = false;
};

}  // namespace tether::client
