#include <tether/sim/world.h>

namespace tether::sim {

namespace {

uav::SensorDescription describe_sensor(const Sensor& sensor) {
  uav::SensorDescription description{sensor.name, sensor.X_BS, sensor.update_rate_hz, {}};
  if (const auto* camera = std::get_if<CameraModel>(&sensor.model)) {
    description.properties = uav::CameraProperties{camera->intrinsics};
  } else if (const auto* range = std::get_if<RangeModel>(&sensor.model)) {
    description.properties = uav::RangeProperties{range->min_m, range->max_m};
  } else {
    description.properties = uav::ImuProperties{};
  }
  return description;
}

}  // namespace

uav::Catalogue make_catalogue(const World& world, const Uav& uav) {
  uav::Catalogue catalogue{uav.name, {}, {}};
  for (const Sensor& sensor : uav.sensors) catalogue.sensors.push_back(describe_sensor(sensor));
  for (const PlacedAnchor& placed : world.anchors) catalogue.anchors.push_back(placed.anchor);
  return catalogue;
}

}  // namespace tether::sim
