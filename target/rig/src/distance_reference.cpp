#include "distance_reference.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <tether/base/text.h>
#include <tether/stats/sample_statistics.h>

namespace tether::rig {
namespace {

constexpr int kReadings = 10;

const uav::SensorDescription* find_rangefinder(const uav::Catalogue& catalogue) {
  const auto found =
      std::find_if(catalogue.sensors.begin(), catalogue.sensors.end(),
                   [](const auto& sensor) { return sensor.kind() == uav::SensorKind::kRange; });
  return found == catalogue.sensors.end() ? nullptr : &*found;
}

DistanceReference none(std::string why) {
  return {std::nullopt, std::move(why)};
}

}  // namespace

std::optional<double> median_of_finite_m(std::vector<double> readings_m) {
  const std::size_t made = readings_m.size();
  const auto is_nothing = [](double reading_m) { return !std::isfinite(reading_m); };
  readings_m.erase(std::remove_if(readings_m.begin(), readings_m.end(), is_nothing),
                   readings_m.end());
  if (readings_m.empty() || 2 * readings_m.size() < made) return std::nullopt;
  std::sort(readings_m.begin(), readings_m.end());
  return stats::quantile(readings_m, 0.5);
}

DistanceReference reference_from(double range_m, const uav::SensorDescription& range,
                                 const uav::SensorDescription& camera, const uav::Anchor& anchor,
                                 double bearing_rad) {
  const uav::Vec3 sight{std::cos(bearing_rad), std::sin(bearing_rad), 0.0};
  const uav::Vec3 beam_end = transform(range.X_BS, {range_m, 0.0, 0.0}) - camera.X_BS.p;
  const double aside_m = std::abs(cross(sight, beam_end).z);
  const double half_width_m = 0.5 * anchor.size_m.y;
  if (aside_m > half_width_m) {
    return none("the rangefinder's beam passes " + fixed(aside_m, 2) +
                " m beside the line of sight; half the anchor's width is " +
                fixed(half_width_m, 2) + " m");
  }
  return {dot(sight, beam_end) + 0.5 * anchor.size_m.x, ""};
}

Result<DistanceReference> take_distance_reference(client::Vehicle& vehicle,
                                                  const uav::SensorDescription& camera,
                                                  const uav::Anchor& anchor, double bearing_rad) {
  const uav::SensorDescription* range = find_rangefinder(vehicle.catalogue());
  if (range == nullptr) return none("there is no rangefinder (--range DEVICE)");
  std::vector<double> readings_m;
  for (int i = 0; i < kReadings; ++i) {
    const Result<uav::RangeSample> reading = vehicle.read<uav::RangeSample>(range->name);
    if (!reading) return reading.failure();
    readings_m.push_back(reading->range_m);
  }
  const std::optional<double> range_m = median_of_finite_m(readings_m);
  if (!range_m) {
    return none("more than half of " + std::to_string(kReadings) + " readings of sensor \"" +
                range->name + "\" found nothing within range");
  }
  return reference_from(*range_m, *range, camera, anchor, bearing_rad);
}

}  // namespace tether::rig
