#include "sensors/scan.h"

#include "sensors/range.h"

#include <cmath>
#include <limits>

namespace tether::sim {
namespace {

constexpr float kNothing_m = std::numeric_limits<float>::infinity();

/// Evenly spaced from the first to the last; a single one lies in the middle.
double angle_rad(double first_rad, double last_rad, int count, int i) {
  return count == 1 ? 0.5 * (first_rad + last_rad)
                    : first_rad + (last_rad - first_rad) * i / (count - 1);
}

float reading_m(const ScanModel& scan, double measured_m) {
  if (scan.resolution_m > 0.0)
    measured_m = scan.resolution_m * std::round(measured_m / scan.resolution_m);
  if (measured_m < scan.rays.min_m) return -kNothing_m;
  return measured_m <= scan.rays.max_m ? static_cast<float>(measured_m) : kNothing_m;
}

void drop(double probability, const MeasurementKey& key, std::vector<float>& ranges_m) {
  if (probability == 0.0) return;
  KeyedRandom random({key.seed, random_stream(key.uav, key.sensor, "dropout"), key.index});
  for (float& range_m : ranges_m)
    if (random.uniform() < probability) range_m = kNothing_m;
}

}  // namespace

std::vector<uav::Vec3> rays_of(const ScanModel& scan) {
  std::vector<uav::Vec3> rays_S;
  const uav::ScanProperties& rays = scan.rays;
  for (int column = 0; column < rays.columns; ++column) {
    const double azimuth_rad =
        angle_rad(rays.min_azimuth_rad, rays.max_azimuth_rad, rays.columns, column);
    for (int row = 0; row < rays.rows; ++row) {
      const double elevation_rad =
          angle_rad(rays.min_elevation_rad, rays.max_elevation_rad, rays.rows, row);
      rays_S.push_back({std::cos(elevation_rad) * std::cos(azimuth_rad),
                        std::cos(elevation_rad) * std::sin(azimuth_rad), std::sin(elevation_rad)});
    }
  }
  return rays_S;
}

std::size_t steps_ago(const ScanModel& scan, int column, Duration step) {
  const int last = scan.rays.columns - 1;
  if (scan.rays.sweep_s <= 0.0 || last == 0) return 0;
  const double ago_s = scan.rays.sweep_s * (last - column) / last;
  return static_cast<std::size_t>(std::llround(ago_s / to_seconds(step)));
}

double farthest_read_m(const ScanModel& scan) {
  RangeModel range;
  range.max_m = scan.rays.max_m;
  range.resolution_m = scan.resolution_m;
  range.noise = scan.noise;
  return farthest_read_m(range);
}

uav::ScanSample measure_scan(const ScanModel& scan, std::span<const double> distances_m,
                             const MeasurementKey& key, std::span<const float> intensities) {
  uav::ScanSample sample{key.at, key.index, std::vector<float>(distances_m.size()),
                         std::vector<float>(intensities.size())};
  const auto rows = static_cast<std::size_t>(scan.rays.rows);
  const auto columns = static_cast<std::size_t>(scan.rays.columns);
  for (std::size_t i = 0; i < distances_m.size(); ++i)
    sample.ranges_m[i % rows * columns + i / rows] = static_cast<float>(distances_m[i]);
  add_depth_noise(scan.noise,
                  {key.seed, random_stream(key.uav, key.sensor, "range"), key.index, key.at},
                  sample.ranges_m);
  for (float& range_m : sample.ranges_m) range_m = reading_m(scan, range_m);
  drop(scan.dropout_probability, key, sample.ranges_m);
  for (std::size_t i = 0; i < intensities.size(); ++i) {
    const std::size_t ray = i % rows * columns + i / rows;
    if (std::isfinite(sample.ranges_m[ray])) sample.intensities[ray] = intensities[i];
  }
  return sample;
}

}  // namespace tether::sim
