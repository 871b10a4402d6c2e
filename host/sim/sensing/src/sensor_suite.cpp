#include "image_maker.h"
#include "sensors.h"

#include <string>
#include <utility>
#include <variant>

#include <tether/base/error.h>
#include <tether/sim_sensing/sensor_suite.h>

namespace tether::sim {

SensorSuite::SensorSuite(const World& world, BackEnd back_end, const WarningSink& warn)
    : world_(world),
      layout_(world),
      rays_(back_end.rays),
      images_(std::make_unique<ImageMaker>(world, std::move(back_end.make_renderer), warn)),
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
  const Sensor& mounted = carrier.sensors[sensor];
  const MeasurementKey key{seed_, carrier.name, mounted.name, index, snapshot.at};
  return std::visit(Visitor{[&](const ImuModel& imu) -> uav::Sample {
                              return measure_imu(
                                  imu, mounted.X_BS, layout_.pose_of(snapshot.state, uav),
                                  layout_.motion_of(snapshot.state, uav), world_.gravity_m_s2, key);
                            },
                            [&](const RangeModel& range) -> uav::Sample {
                              cast(range, snapshot.state, uav, mounted.X_BS);
                              return measure_range(range, distances_m_, key);
                            },
                            [&](const CameraModel& camera) -> uav::Sample {
                              return images_->make(camera, {snapshot.state, uav, mounted, key});
                            }},
                    mounted.model);
}

std::string SensorSuite::renderer_name() const {
  return images_->renderer_name();
}

void SensorSuite::cast(const RangeModel& range, const std::vector<double>& state, std::size_t uav,
                       const uav::Pose& X_BS) {
  for (std::size_t i = 0; i < X_WB_.size(); ++i) X_WB_[i] = layout_.pose_of(state, i);
  distances_m_.resize(range.rays_S.size());
  rays_.cast({X_WB_[uav] * X_BS, range.rays_S, X_WB_, uav, farthest_read_m(range)}, distances_m_);
}

}  // namespace tether::sim
