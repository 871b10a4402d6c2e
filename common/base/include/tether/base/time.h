#pragma once

#include <chrono>
#include <cstdint>

/// The clocks of a run (paper, Section II). Three time axes meet in Tether; each has a type of its
/// own, and none converts into another except through a function whose name says what is claimed.
namespace tether {

/// A span of time on any of the axes [ns]. Exact: no rounding ever happens between integers.
using Duration = std::chrono::duration<std::int64_t, std::nano>;

/// Simulated time (ST): the simulator's clock. It moves only when the simulator steps, so it has no
/// `now()`.
struct SimClock {
  using rep = Duration::rep;
  using period = Duration::period;
  using duration = Duration;
  using time_point = std::chrono::time_point<SimClock>;
  static constexpr bool is_steady = true;
  static time_point now() = delete;
};

/// Execution time (ET) of one SUT: how long it was free to execute. It stands still while the SUT
/// is held.
struct ExecClock {
  using rep = Duration::rep;
  using period = Duration::period;
  using duration = Duration;
  using time_point = std::chrono::time_point<ExecClock>;
  static constexpr bool is_steady = true;
  static time_point now() = delete;
};

/// Wall time (WT) of one machine since an origin that the machine chose. For the record only.
struct WallClock {
  using rep = Duration::rep;
  using period = Duration::period;
  using duration = Duration;
  using time_point = std::chrono::time_point<WallClock>;
  static constexpr bool is_steady = true;
  static time_point now() = delete;
};

using SimTime = SimClock::time_point;
using ExecTime = ExecClock::time_point;
using WallTime = WallClock::time_point;

/// The instant of ST that carries the same timestamp as `et`. This is the identification on which
/// the method rests: a SUT at ET t may only meet the world of ST t (paper, Section II).
constexpr SimTime same_instant(ExecTime et) {
  return SimTime(et.time_since_epoch());
}
/// The instant of ET that carries the same timestamp as `st`.
constexpr ExecTime same_instant(SimTime st) {
  return ExecTime(st.time_since_epoch());
}

/// The lag ε = ET − ST of a SUT at the moment when its request arrives. Positive: the simulation is
/// behind.
constexpr Duration lag(ExecTime et, SimTime st) {
  return et.time_since_epoch() - st.time_since_epoch();
}

/// Nanoseconds since the axis' origin, for files and frames.
template <class Clock>
constexpr std::int64_t to_ns(std::chrono::time_point<Clock, Duration> t) {
  return t.time_since_epoch().count();
}
constexpr std::int64_t to_ns(Duration d) {
  return d.count();
}

/// The time point `ns` nanoseconds after the axis' origin: `from_ns<SimTime>(1'000'000)`.
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

}  // namespace tether
