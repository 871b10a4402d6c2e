#include <algorithm>
#include <cmath>

#include <tether/sync/clock_plausibility.h>

namespace tether::sync {

namespace {

constexpr Duration kReading = std::chrono::milliseconds(1);
constexpr Duration kTick = std::chrono::milliseconds(10);
constexpr Duration kGrandchildren = std::chrono::milliseconds(20);
constexpr Duration kMostUnaccounted = std::chrono::seconds(1);

Duration stretched(Duration measured, double factor) {
  return Duration(std::llround(static_cast<double>(measured.count()) * factor));
}

}  // namespace

ClockBound wall_bound(double factor) {
  return {.rate = factor, .slack = stretched(kReading, factor)};
}

ClockBound cpu_bound(double factor, int cores) {
  const int most = cores > 0 ? cores : kMostCores;
  return {.rate = factor * most,
          .slack = stretched(std::min(most * kTick, kMostUnaccounted) + kGrandchildren, factor)};
}

void ClockPlausibility::go_on(ExecTime at, WallTime now) {
  et_ = at;
  wall_ = now;
}

Duration ClockPlausibility::excess(ExecTime stamp, WallTime now) const {
  const auto elapsed_ns = static_cast<double>((now - wall_).count());
  const double most_ns =
      bound_.rate * elapsed_ns * (1.0 + kDrift) + static_cast<double>(bound_.slack.count());
  const Duration grown = stamp - et_;
  if (static_cast<double>(grown.count()) <= most_ns) return Duration(0);
  return grown - Duration(std::llround(most_ns));
}

}  // namespace tether::sync
