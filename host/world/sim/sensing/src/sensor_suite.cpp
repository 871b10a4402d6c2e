#include "ahead_drawer.h"
#include "image_maker.h"
#include "sensors/imu.h"
#include "sensors/joint_state.h"
#include "sensors/navigation.h"
#include "sensors/range.h"
#include "sensors/scan.h"

#include <span>
#include <string>
#include <utility>
#include <variant>

#include <tether/base/error.h>
#include <tether/sim_sensing/sensor_suite.h>

namespace tether::sim {

SensorSuite::SensorSuite(const World& world, const BackEnd& back_end, const WarningSink& warn)
    : world_(world), layout_(world), rays_(back_end.rays), X_WB_(layout_.bodies()) {
  if (back_end.threads_ahead > 0) {
    ahead_ = std::make_unique<AheadDrawer>(
        back_end.threads_ahead,
        [this](std::size_t worker, const PictureKey& key, const Snapshot& snapshot) {
          return draw(*images_[worker], snapshot, key.uav, key.sensor, key.index);
        });
  }
  for (int i = 0; i < back_end.threads_ahead; ++i) {
    images_.push_back(std::make_unique<ImageMaker>(world, back_end.make_renderer, ahead_.get(),
                                                   [](const Warning&) {}));
  }
  images_.push_back(
      std::make_unique<ImageMaker>(world, back_end.make_renderer, ahead_.get(), warn));
}

SensorSuite::~SensorSuite() = default;

void SensorSuite::reset(std::uint64_t seed) {
  if (ahead_) ahead_->reset();
  work_ = {};
  seed_ = seed;
}

uav::Sample SensorSuite::measure(const Snapshot& snapshot, std::size_t uav, std::size_t sensor,
                                 std::uint64_t index) {
  const Sensor& mounted = sensor_of(uav, sensor);
  const MeasurementKey key{seed_, world_.uavs[uav].name, mounted.name, index, snapshot.at};
  const Place place = world_.place.value_or(Place{});
  const auto truth = [&] {
    return motion_of_sensor(layout_.pose_of(snapshot.state, uav),
                            layout_.motion_of(snapshot.state, uav), mounted.X_BS);
  };
  return std::visit(
      Visitor{[&](const ImuModel& imu) -> uav::Sample {
                return measure_imu(imu, mounted.X_BS, layout_.pose_of(snapshot.state, uav),
                                   layout_.motion_of(snapshot.state, uav), felt_at_rest(world_),
                                   key);
              },
              [&](const RangeModel& range) -> uav::Sample {
                cast(range, snapshot.state, uav, mounted);
                return measure_range(range, distances_m_, key);
              },
              [&](const ScanModel& scan) -> uav::Sample {
                cast(scan, snapshot.state, uav, mounted);
                return measure_scan(scan, distances_m_, key, intensities_);
              },
              [&](const CameraModel&) { return picture(snapshot, uav, sensor, index); },
              [&](const NavSatModel& navsat) -> uav::Sample {
                return measure_navsat(navsat, truth(), place, key);
              },
              [&](const MagnetometerModel& magnetometer) -> uav::Sample {
                return measure_magnetometer(magnetometer, truth(), world_.magnetic_field_T, key);
              },
              [&](const BarometerModel& barometer) -> uav::Sample {
                return measure_barometer(barometer, truth(), place, key);
              },
              [&](const OdometryModel& odometry) -> uav::Sample {
                return measure_odometry(odometry, truth(), key);
              },
              [&](const JointStateModel& joints) -> uav::Sample {
                return measure_joint_state(joints, world_.uavs[uav].joints,
                                           layout_.angles_of(snapshot.state, uav), key);
              }},
      mounted.model);
}

const Sensor& SensorSuite::sensor_of(std::size_t uav, std::size_t sensor) const {
  if (uav >= world_.uavs.size()) {
    throw Error(ErrorCode::kInternal, "simulator: no UAV " + std::to_string(uav));
  }
  if (sensor >= world_.uavs[uav].sensors.size()) {
    throw Error(ErrorCode::kInternal, "simulator: no sensor " + std::to_string(sensor));
  }
  return world_.uavs[uav].sensors[sensor];
}

uav::Sample SensorSuite::picture(const Snapshot& snapshot, std::size_t uav, std::size_t sensor,
                                 std::uint64_t index) {
  if (ahead_) {
    if (auto sample = ahead_->take({uav, sensor, index, snapshot.at})) return std::move(*sample);
  }
  const CpuTimer timer;
  uav::Sample sample = draw(*images_.back(), snapshot, uav, sensor, index);
  work_.drawing += timer.elapsed();
  ++work_.pictures;
  seen_.insert(&world_.uavs[uav].sensors[sensor]);
  return sample;
}

// Called by several threads, each with `images` of its own.
uav::Sample SensorSuite::draw(ImageMaker& images, const Snapshot& snapshot, std::size_t uav,
                              std::size_t sensor, std::uint64_t index) const {
  const Uav& carrier = world_.uavs[uav];
  const Sensor& mounted = carrier.sensors[sensor];
  const MeasurementKey key{seed_, carrier.name, mounted.name, index, snapshot.at};
  return images.make(std::get<CameraModel>(mounted.model), {snapshot.state, uav, mounted, key});
}

void SensorSuite::expect(const Snapshot& snapshot, std::size_t uav, std::size_t sensor,
                         std::uint64_t index) {
  const bool may_be_ahead = ahead_ && seen_.contains(&sensor_of(uav, sensor));
  if (may_be_ahead) ahead_->expect({uav, sensor, index, snapshot.at}, snapshot);
}

SimulatorWork SensorSuite::work() const {
  SimulatorWork work = ahead_ ? ahead_->work() : SimulatorWork{};
  work.drawing += work_.drawing;
  work.pictures += work_.pictures;
  return work;
}

// A ray goes on behind each hit. The UAVs are put far away, so that none is hit.
int SensorSuite::walls_between(const Snapshot& snapshot, std::size_t uav, std::size_t other) {
  constexpr double kFarAway_m = 1e6;
  constexpr double kBehind_m = 1e-3;
  constexpr int kMostHits = 64;
  for (std::size_t i = 0; i < X_WB_.size(); ++i) X_WB_[i] = layout_.pose_of(snapshot.state, i);
  uav::Pose X_WS{X_WB_[uav].p, {}};
  const uav::Vec3 way = X_WB_[other].p - X_WS.p;
  double left_m = uav::norm(way);
  if (left_m < kBehind_m) return 0;
  const uav::Vec3 direction = (1.0 / left_m) * way;
  for (std::size_t i = 0; i < world_.uavs.size(); ++i) X_WB_[i].p.z += kFarAway_m;
  int hits = 0;
  while (left_m > 0.0 && hits < kMostHits) {
    double distance_m = 0.0;
    rays_.cast({X_WS, {&direction, 1}, X_WB_, uav, left_m}, {&distance_m, 1});
    if (distance_m >= left_m) break;
    ++hits;
    X_WS.p = X_WS.p + (distance_m + kBehind_m) * direction;
    left_m -= distance_m + kBehind_m;
  }
  return (hits + 1) / 2;
}

std::string SensorSuite::renderer_name() const {
  return images_.back()->renderer_name();
}

// Columns that are measured at the same step are cast together, with the poses of that step.
void SensorSuite::cast(const ScanModel& scan, const std::vector<double>& state, std::size_t uav,
                       const Sensor& mounted) {
  const auto [known, is_new] = rays_S_.try_emplace(&mounted);
  if (is_new) known->second = rays_of(scan);
  const std::span<const uav::Vec3> rays_S = known->second;
  distances_m_.resize(rays_S.size());
  intensities_.resize(rays_S.size());
  const std::span<double> distances_m = distances_m_;
  const std::span<float> intensities = intensities_;
  bool is_known = true;
  const auto rows = static_cast<std::size_t>(scan.rays.rows);
  for (int first = 0, end = 0; first < scan.rays.columns; first = end) {
    const std::size_t steps = steps_ago(scan, first, world_.step);
    while (end < scan.rays.columns && steps_ago(scan, end, world_.step) == steps) ++end;
    for (std::size_t i = 0; i < X_WB_.size(); ++i) X_WB_[i] = layout_.past_pose_of(state, i, steps);
    const std::size_t from = static_cast<std::size_t>(first) * rows;
    const std::size_t count = static_cast<std::size_t>(end - first) * rows;
    const RayBundle bundle{X_WB_[uav] * layout_.mounting(state, world_, uav, mounted, steps),
                           rays_S.subspan(from, count), X_WB_, uav, farthest_read_m(scan)};
    const auto distances = distances_m.subspan(from, count);
    is_known = rays_.cast_with_intensities(bundle, distances, intensities.subspan(from, count));
    if (!is_known) rays_.cast(bundle, distances);
  }
  if (!is_known) intensities_.clear();
}

void SensorSuite::cast(const RangeModel& range, const std::vector<double>& state, std::size_t uav,
                       const Sensor& mounted) {
  for (std::size_t i = 0; i < X_WB_.size(); ++i) X_WB_[i] = layout_.pose_of(state, i);
  distances_m_.resize(range.rays_S.size());
  rays_.cast({X_WB_[uav] * layout_.mounting(state, world_, uav, mounted), range.rays_S, X_WB_, uav,
              farthest_read_m(range)},
             distances_m_);
}

}  // namespace tether::sim
