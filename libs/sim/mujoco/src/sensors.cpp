#include "sensors.h"

#include "conversions.h"
#include "physics_model.h"
#include "sensor_noise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tether::sim {
namespace {

using uav::Vec3;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

NoiseKey noise_key(const MeasurementKey& key, std::string_view channel) {
  return {key.seed, random_stream(key.uav, key.sensor, channel), key.index, key.at};
}

Vec3 noise_vector(const std::array<Noise, 3>& noise, const MeasurementKey& key,
                  const std::array<std::string_view, 3>& channels) {
  return {noise_value(noise[0], noise_key(key, channels[0])),
          noise_value(noise[1], noise_key(key, channels[1])),
          noise_value(noise[2], noise_key(key, channels[2]))};
}

// Acceleration of S's origin less gravity, in B.
Vec3 specific_force_B(const Vec3& p_BS, const uav::Quat& q_WB, const BodyMotion& motion,
                      double gravity_m_s2) {
  const Vec3 f_W = motion.a_WB_W + Vec3{0.0, 0.0, gravity_m_s2};
  return rotate(inverse(q_WB), f_W) + cross(motion.alpha_WB_B, p_BS) +
         cross(motion.w_WB_B, cross(motion.w_WB_B, p_BS));
}

bool is_dropped(const RangeModel& range, const MeasurementKey& key) {
  if (range.dropout_probability == 0.0) return false;
  const std::uint64_t stream = random_stream(key.uav, key.sensor, "dropout");
  return KeyedRandom({key.seed, stream, key.index}).uniform() < range.dropout_probability;
}

}  // namespace

uav::ImuSample measure_imu(const ImuModel& imu, const uav::Pose& X_BS, const uav::Pose& X_WB,
                           const BodyMotion& motion, double gravity_m_s2,
                           const MeasurementKey& key) {
  const uav::Quat q_SB = inverse(X_BS.q);
  const Vec3 f_B = specific_force_B(X_BS.p, X_WB.q, motion, gravity_m_s2);
  uav::ImuSample sample;
  sample.sampled_at = key.at;
  sample.index = key.index;
  sample.angular_velocity_rad_s =
      rotate(q_SB, motion.w_WB_B) +
      noise_vector(imu.angular_velocity, key, {"rate_x", "rate_y", "rate_z"});
  sample.specific_force_m_s2 = rotate(q_SB, f_B) + noise_vector(imu.linear_acceleration, key,
                                                                {"force_x", "force_y", "force_z"});
  sample.q_WS = X_WB.q * X_BS.q;
  return sample;
}

uav::RangeSample measure_range(const RangeModel& range, double distance_m,
                               const MeasurementKey& key) {
  uav::RangeSample sample{key.at, key.index, kInfinity};
  if (distance_m == kInfinity || is_dropped(range, key)) return sample;
  double measured_m = distance_m + noise_value(range.noise, noise_key(key, "range"));
  if (range.resolution_m > 0.0) {
    measured_m = range.resolution_m * std::round(measured_m / range.resolution_m);
  }
  if (measured_m <= range.max_m) sample.range_m = measured_m;
  if (measured_m < range.min_m) sample.range_m = -kInfinity;
  return sample;
}

RayCaster::RayCaster(const Dynamics& dynamics)
    : dynamics_(dynamics), data_(make_data(dynamics.model())) {}

double RayCaster::cast(const std::vector<double>& state, const uav::Pose& X_WS,
                       const std::vector<uav::Vec3>& rays_S, std::size_t uav) {
  const mjModel& model = dynamics_.model();
  std::copy_n(state.begin(), model.nq, data_->qpos);
  mj_kinematics(&model, data_.get());
  std::array<mjtNum, 3> origin{};
  copy_to(X_WS.p, origin.data());
  double nearest_m = kInfinity;
  for (const Vec3& ray_S : rays_S) {
    std::array<mjtNum, 3> direction{};
    copy_to(rotate(X_WS.q, ray_S), direction.data());
    int geom = -1;
    const double distance_m = mj_ray(&model, data_.get(), origin.data(), direction.data(), nullptr,
                                     1, engine_body(uav), &geom);
    if (geom >= 0) nearest_m = std::min(nearest_m, distance_m);
  }
  return nearest_m;
}

}  // namespace tether::sim
