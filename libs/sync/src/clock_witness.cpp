#include <cmath>

#include <tether/sync/clock_witness.h>

namespace tether::sync {

void ClockWitness::go_on(ExecTime at, WallTime now) {
  et_ = at;
  wall_ = now;
}

Duration ClockWitness::excess(ExecTime stamp, WallTime now) const {
  const auto elapsed_ns = static_cast<double>((now - wall_).count());
  const double most_ns =
      rate_ * (elapsed_ns * (1.0 + kDrift) + static_cast<double>(kJitter.count()));
  const Duration grown = stamp - et_;
  if (static_cast<double>(grown.count()) <= most_ns) return Duration(0);
  return grown - Duration(std::llround(most_ns));
}

}  // namespace tether::sync
