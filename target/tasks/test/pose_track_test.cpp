#include "pose_track.h"

#include <gtest/gtest.h>

namespace tether::tasks {
namespace {

SimTime at_ms(int ms) {
  return SimTime(std::chrono::milliseconds(ms));
}

uav::OdometrySample odometry(int ms, const uav::Vec3& p_WS, const uav::Vec3& v_WS) {
  uav::OdometrySample sample;
  sample.sampled_at = at_ms(ms);
  sample.p_WS = p_WS;
  sample.v_WS_m_s = v_WS;
  return sample;
}

/// Of an IMU that is turned by q_BS and moves with the acceleration.
uav::ImuSample reading(int ms, const uav::Vec3& a_W, const uav::Quat& q_BS) {
  uav::ImuSample sample;
  sample.sampled_at = at_ms(ms);
  sample.q_WS = uav::from_axis_angle({0, 0, 1}, 0.5) * q_BS;
  sample.specific_force_m_s2 = rotate(inverse(sample.q_WS), a_W + uav::Vec3{0, 0, 9.81});
  return sample;
}

TEST(PoseTrack, FollowsEachMotionByTheImu) {
  const uav::Quat q_BS = uav::from_rpy(0.1, 0.2, 0.3);
  PoseTrack track(q_BS);
  track.update(reading(0, {}, q_BS));
  EXPECT_FALSE(track.has_started());
  track.update(odometry(0, {1.0, 2.0, 3.0}, {0.5, 0.0, 0.0}));
  for (int ms = 0; ms <= 1000; ms += 5) track.update(reading(ms, {0.0, 2.0, -1.0}, q_BS));
  track.update(reading(500, {100.0, 0.0, 0.0}, q_BS));  // an old one
  EXPECT_LT(norm(track.now().p_WB - uav::Vec3{1.5, 3.0, 2.5}), 0.02);
  EXPECT_LT(norm(track.now().v_WB_m_s - uav::Vec3{0.5, 2.0, -1.0}), 0.02);
  EXPECT_NEAR(uav::yaw_rad(track.now().q_WB), 0.5, 1e-9);
  EXPECT_LT(norm(track.at(at_ms(501)).p_WB - uav::Vec3{1.25, 2.25, 2.875}), 0.02);
}

TEST(PoseTrack, IsHeldInPlaceByTheOdometry) {
  const uav::Vec3 bias{0.3, -0.2, 0.1};
  PoseTrack track;
  track.update(odometry(0, {}, {}));
  for (int ms = 0; ms <= 5000; ms += 5) {
    track.update(reading(ms, bias, {}));
    if (ms % 50 == 0) track.update(odometry(ms, {}, {}));
  }
  EXPECT_LT(norm(track.now().p_WB), 0.1);
}

TEST(PoseTrack, CorrectsByWhereItWasAtTheOdometrysInstant) {
  PoseTrack track;
  track.update(odometry(0, {}, {2.0, 0.0, 0.0}));
  for (int ms = 0; ms <= 1000; ms += 5) {
    track.update(reading(ms, {}, {}));
    if (ms < 200 || ms % 50 != 0) continue;
    const double then_s = 1e-3 * (ms - 200);  // it arrives late
    track.update(odometry(ms - 200, {2.0 * then_s, 0.0, 0.0}, {2.0, 0.0, 0.0}));
  }
  EXPECT_NEAR(track.now().p_WB.x, 2.0, 0.02);
}

}  // namespace
}  // namespace tether::tasks
