#include "sensors/range.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace tether::sim {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// In standard deviations: KeyedRandom's normal distribution ends at 8.6.
constexpr double kNoDrawBeyond = 9.0;

double nearest_of(std::span<const double> distances_m) {
  return std::accumulate(distances_m.begin(), distances_m.end(), kInfinity,
                         [](double a, double b) { return std::min(a, b); });
}

}  // namespace

double farthest_read_m(const RangeModel& range) {
  const Noise& n = range.noise;
  const double walk_stddev =
      n.dynamic_bias_stddev * std::sqrt(0.5 * std::max(0.0, n.dynamic_bias_correlation_time_s));
  return range.max_m + 0.5 * range.resolution_m + std::abs(n.mean) + std::abs(n.bias_mean) +
         kNoDrawBeyond * (n.stddev + n.bias_stddev + walk_stddev);
}

uav::RangeSample measure_range(const RangeModel& range, std::span<const double> distances_m,
                               const MeasurementKey& key) {
  const double distance_m = nearest_of(distances_m);
  uav::RangeSample sample{key.at, key.index, kInfinity};
  if (distance_m == kInfinity || is_dropped(range.dropout_probability, key)) return sample;
  double measured_m = distance_m + noise_of(range.noise, key, "range");
  if (range.resolution_m > 0.0) {
    measured_m = range.resolution_m * std::round(measured_m / range.resolution_m);
  }
  if (measured_m <= range.max_m) sample.range_m = measured_m;
  if (measured_m < range.min_m) sample.range_m = -kInfinity;
  return sample;
}

}  // namespace tether::sim
