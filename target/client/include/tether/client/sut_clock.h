#pragma once

#include <memory>
#include <string>

#include <tether/base/result.h>
#include <tether/base/time.h>
#include <tether/link/messages.h>

namespace tether::client {

/// Where a SUT's execution time comes from (DESIGN section 2, "How a SUT's time is measured").
/// Monotone. Thread-safe.
class TimeSource {
 public:
  virtual ~TimeSource() = default;
  virtual link::ClockKind kind() const = 0;
  /// Seconds of ET per second of what is measured; 1 except for a virtual target.
  virtual double factor() const { return 1.0; }
  /// Time measured since an origin of its own, already scaled by `factor()`.
  virtual Duration elapsed() const = 0;

  /// From here to the release, the calling thread works for the client library and not for the SUT;
  /// a source that can tell threads apart does not measure it. One thread at a time.
  virtual void exclude_calling_thread() {}
  /// @pre called by the thread that is excluded, before it ends.
  virtual void release_calling_thread() {}
};

/// The machine's monotonic clock × factor. Other than 1: a virtual target whose every moment
/// counts, also those in which its program waits for something; for threads, of which CPU time says
/// little.
/// @pre factor > 0.
std::unique_ptr<TimeSource> make_wall_source(double factor = 1.0);
/// CPU time of this process (all threads but an excluded one) × factor: a virtual target. @pre
/// factor > 0.
std::unique_ptr<TimeSource> make_cpu_source(double factor);
/// A scripted SUT that takes `step` for every phase of computing between two interactions, whatever
/// the machine does: time moves by `step` each time it is read, and every interaction starts with
/// one reading. So each call of `now()` costs a step as well, and each annotation one. For tests
/// and for runs that must repeat to the byte.
std::unique_ptr<TimeSource> make_scripted_source(Duration step);

/// The source that TETHER_CLOCK names: "wall", "wall*FACTOR", "cpu", "cpu*FACTOR" (FACTOR within
/// 1e-6..1e6), "scripted*MILLISECONDS". Fails with kInvalid, saying what is allowed.
Result<std::unique_ptr<TimeSource>> parse_time_source(const std::string& text);

/// ET of this SUT: runs with its source while the SUT is free, stands still while it is held, and
/// goes on from exactly the timestamp it is given (paper, Section II: the timer that is paused;
/// DESIGN section 2, rules 5 and 6).
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
