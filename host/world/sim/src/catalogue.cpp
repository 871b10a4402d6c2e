#include <tether/sim/world.h>

namespace tether::sim {

namespace {

uav::CameraProperties describe(const World& world, const CameraModel& camera) {
  uav::CameraProperties properties{camera.intrinsics, camera.kind, camera.depth_min_m,
                                   camera.depth_max_m};
  if (camera.kind == uav::CameraKind::kSegmentation) properties.models = model_names(world);
  return properties;
}

uav::ImuProperties describe(const World&, const ImuModel&) {
  return {};
}
uav::RangeProperties describe(const World&, const RangeModel& range) {
  return {range.min_m, range.max_m};
}
uav::NavSatProperties describe(const World&, const NavSatModel&) {
  return {};
}
uav::MagnetometerProperties describe(const World&, const MagnetometerModel&) {
  return {};
}
uav::BarometerProperties describe(const World&, const BarometerModel&) {
  return {};
}
uav::OdometryProperties describe(const World&, const OdometryModel&) {
  return {};
}

uav::JointStateProperties describe(const World&, const JointStateModel&) {
  return {};
}

uav::ScanProperties describe(const World&, const ScanModel& scan) {
  return scan.rays;
}

uav::SensorDescription describe_sensor(const World& world, const Sensor& sensor) {
  using Properties = decltype(uav::SensorDescription::properties);
  return {sensor.name,
          sensor.X_BS,
          sensor.update_rate_hz,
          std::visit([&](const auto& model) -> Properties { return describe(world, model); },
                     sensor.model),
          sensor.driver != uav::DriverModel{},
          static_cast<std::uint32_t>(sensor.joints)};
}

}  // namespace

const std::string& model_name(const World& world, std::size_t number) {
  const std::size_t models = world.models.size();
  return number <= models ? world.models.at(number - 1).name
                          : world.uavs.at(number - 1 - models).name;
}

std::vector<std::string> model_names(const World& world) {
  std::vector<std::string> names;
  for (std::size_t i = 1; i <= world.models.size() + world.uavs.size(); ++i)
    names.push_back(model_name(world, i));
  return names;
}

uav::Catalogue make_catalogue(const World& world, const Uav& uav) {
  uav::Catalogue catalogue{uav.name, {}, {}};
  catalogue.limits.joints = uav.joints;
  for (const Sensor& sensor : uav.sensors)
    catalogue.sensors.push_back(describe_sensor(world, sensor));
  for (const PlacedAnchor& placed : world.anchors)
    if (placed.anchor.name != uav.name) catalogue.anchors.push_back(placed.anchor);
  return catalogue;
}

}  // namespace tether::sim
