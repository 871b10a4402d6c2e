#include "sensors/imu.h"

namespace tether::sim {
namespace {

using uav::Vec3;

// Acceleration of S's origin less gravity, in B.
Vec3 specific_force_B(const Vec3& p_BS, const uav::Quat& q_WB, const BodyMotion& motion,
                      const Vec3& at_rest_W) {
  const Vec3 f_W = motion.a_WB_W + at_rest_W;
  return rotate(inverse(q_WB), f_W) + cross(motion.alpha_WB_B, p_BS) +
         cross(motion.w_WB_B, cross(motion.w_WB_B, p_BS));
}

}  // namespace

uav::ImuSample measure_imu(const ImuModel& imu, const uav::Pose& X_BS, const uav::Pose& X_WB,
                           const BodyMotion& motion, const Vec3& at_rest_W,
                           const MeasurementKey& key) {
  const uav::Quat q_SB = inverse(X_BS.q);
  const Vec3 f_B = specific_force_B(X_BS.p, X_WB.q, motion, at_rest_W);
  uav::ImuSample sample;
  sample.sampled_at = key.at;
  sample.index = key.index;
  sample.angular_velocity_rad_s =
      rotate(q_SB, motion.w_WB_B) +
      noise_of(imu.angular_velocity, key, {"rate_x", "rate_y", "rate_z"});
  sample.specific_force_m_s2 =
      rotate(q_SB, f_B) + noise_of(imu.linear_acceleration, key, {"force_x", "force_y", "force_z"});
  sample.q_WS = X_WB.q * X_BS.q;
  return sample;
}

}  // namespace tether::sim
