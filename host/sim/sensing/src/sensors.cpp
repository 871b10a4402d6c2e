#include "sensors.h"

#include "sensor_noise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace tether::sim {
namespace {

using uav::Vec3;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// In standard deviations: KeyedRandom's normal distribution ends at 8.6.
constexpr double kNoDrawBeyond = 9.0;

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

double nearest_of(std::span<const double> distances_m) {
  return std::accumulate(distances_m.begin(), distances_m.end(), kInfinity,
                         [](double a, double b) { return std::min(a, b); });
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
  if (distance_m == kInfinity || is_dropped(range, key)) return sample;
  double measured_m = distance_m + noise_value(range.noise, noise_key(key, "range"));
  if (range.resolution_m > 0.0) {
    measured_m = range.resolution_m * std::round(measured_m / range.resolution_m);
  }
  if (measured_m <= range.max_m) sample.range_m = measured_m;
  if (measured_m < range.min_m) sample.range_m = -kInfinity;
  return sample;
}

}  // namespace tether::sim
