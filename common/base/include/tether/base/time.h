#pragma once

#include <chrono>
#include <cstdint>

/// The clocks of a run (paper, Section II). Tether has three time axes. Each has its own type, and
/// only the named functions below convert between them.
namespace tether {

/// A span of time on any of the axes [ns]. Exact: no rounding ever happens between integers.
using Duration = std::chrono::duration<std::int64_t, std::nano>;

/// What the clocks of the three axes have in common. `Axis` is the clock itself, so that each has
/// time points of its own type. None has a `now()`: times are arguments.
template <class Axis>
struct AxisClock {
  using rep = Duration::rep;
  using period = Duration::period;
  using duration = Duration;
  using time_point = std::chrono::time_point<Axis, Duration>;
  static constexpr bool is_steady = true;
  static time_point now() = delete;
};

/// Simulated time (ST): the simulator's clock. It advances only when the simulator steps.
struct SimClock : AxisClock<SimClock> {};

/// Execution time (ET) of one SUT: how long it was free to execute. It is paused while the SUT is
/// held.
struct ExecClock : AxisClock<ExecClock> {};

/// Wall time (WT) of one machine since an origin that the machine chose. For the record only.
struct WallClock : AxisClock<WallClock> {};

using SimTime = SimClock::time_point;
using ExecTime = ExecClock::time_point;
using WallTime = WallClock::time_point;

/// The instant of ST with the same timestamp as `et`. The method is based on this: a SUT at ET t
/// may only interact with the world of ST t (paper, Section II).
constexpr SimTime same_instant(ExecTime et) {
  return SimTime(et.time_since_epoch());
}
/// The instant of ET with the same timestamp as `st`.
constexpr ExecTime same_instant(SimTime st) {
  return ExecTime(st.time_since_epoch());
}

/// The lag ε = ET − ST of a SUT when its request arrives. Positive if the simulation is behind.
constexpr Duration lag(ExecTime et, SimTime st) {
  return et.time_since_epoch() - st.time_since_epoch();
}

/// Nanoseconds since the origin of the axis, for files and frames.
template <class Clock>
constexpr std::int64_t to_ns(std::chrono::time_point<Clock, Duration> t) {
  return t.time_since_epoch().count();
}
constexpr std::int64_t to_ns(Duration d) {
  return d.count();
}

/// The time point `ns` nanoseconds after the origin of the axis: `from_ns<SimTime>(1'000'000)`.
template <class Time>
constexpr Time from_ns(std::int64_t ns) {
  return Time(Duration(ns));
}

/// Seconds as a double, for files, displays and simulator interfaces only. The round trip through
/// `duration_from_seconds` is exact up to 2^51 ns (26 days).
constexpr double to_seconds(Duration d) {
  return static_cast<double>(d.count()) / 1e9;
}
template <class Clock>
constexpr double to_seconds(std::chrono::time_point<Clock, Duration> t) {
  return to_seconds(t.time_since_epoch());
}

/// The nearest whole nanosecond to `seconds`; halves away from zero. Saturates at the limits of
/// int64, and a NaN becomes 0, so that no input is undefined behaviour; check user input with
/// `is_representable_seconds` first.
Duration duration_from_seconds(double seconds);

/// Whether `seconds` is finite and fits an int64 of nanoseconds.
bool is_representable_seconds(double seconds);

/// The simulator's time grid: step boundaries k·dt, k ≥ 0. Times of samples are rounded down, times
/// of commands up (DESIGN section 2, rules 1 to 3), so that neither data nor a command moves across
/// its timestamp. An immutable value; thread-safe.
class StepGrid {
 public:
  /// @pre dt > 0.
  constexpr explicit StepGrid(Duration dt) : dt_(dt) {}

  constexpr Duration dt() const { return dt_; }
  /// The last step boundary ≤ t. @pre t ≥ 0.
  constexpr SimTime floor(SimTime t) const { return t - t.time_since_epoch() % dt_; }
  /// The first step boundary ≥ t. @pre 0 ≤ t ≤ SimTime::max() − dt.
  constexpr SimTime ceil(SimTime t) const { return floor(t + dt_ - Duration(1)); }
  constexpr bool contains(SimTime t) const {
    return t.time_since_epoch() % dt_ == Duration::zero();
  }

  friend constexpr bool operator==(const StepGrid&, const StepGrid&) = default;

 private:
  Duration dt_;
};

}  // namespace tether
