#include "image_maker.h"
#include "sensors.h"

#include <string>
#include <utility>
#include <variant>

#include <tether/base/error.h>
#include <tether/sim_sensing/sensor_suite.h>

namespace tether::sim {

struct SensorSuite::Request {
  const Snapshot& snapshot;
  std::size_t uav;
  const Sensor& sensor;
  MeasurementKey key;
};

SensorSuite::SensorSuite(const World& world, BackEnd back_end, const WarningSink& warn)
    : world_(world),
      layout_(world),
      rays_(back_end.rays),
      images_(std::make_unique<ImageMaker>(world, std::move(back_end.body_radii_m),
                                           std::move(back_end.make_renderer), warn)),
      X_WB_(layout_.bodies()) {}

SensorSuite::~SensorSuite() = default;

uav::Sample SensorSuite::measure(const Snapshot& snapshot, std::size_t uav, std::size_t sensor,
                                 std::uint64_t index) {
  if (uav >= world_.uavs.size()) {
    throw Error(ErrorCode::kInternal, "simulator: no UAV " + std::to_string(uav));
  }
  const Uav& carrier = world_.uavs[uav];
  if (sensor >= carrier.sensors.size()) {
    throw Error(ErrorCode::kInternal, "simulator: no sensor " + std::to_string(sensor));
  }
  const Sensor& description = carrier.sensors[sensor];
  const Request request{
      snapshot, uav, description, {seed_, carrier.name, description.name, index, snapshot.at}};
  return std::visit([&](const auto& model) { return measure(model, request); }, description.model);
}

std::string SensorSuite::renderer_name() const {
  return images_->renderer_name();
}

uav::Sample SensorSuite::measure(const ImuModel& imu, const Request& r) {
  return measure_imu(imu, r.sensor.X_BS, layout_.pose_of(r.snapshot.state, r.uav),
                     layout_.motion_of(r.snapshot.state, r.uav), world_.gravity_m_s2, r.key);
}

uav::Sample SensorSuite::measure(const RangeModel& range, const Request& r) {
  for (std::size_t i = 0; i < X_WB_.size(); ++i) X_WB_[i] = layout_.pose_of(r.snapshot.state, i);
  distances_m_.resize(range.rays_S.size());
  const uav::Pose X_WS = X_WB_[r.uav] * r.sensor.X_BS;
  rays_.cast({X_WS, range.rays_S, X_WB_, r.uav, farthest_read_m(range)}, distances_m_);
  return measure_range(range, distances_m_, r.key);
}

uav::Sample SensorSuite::measure(const CameraModel& camera, const Request& r) {
  return images_->make(camera, {r.snapshot.state, r.uav, r.sensor, r.key});
}

}  // namespace tether::sim
