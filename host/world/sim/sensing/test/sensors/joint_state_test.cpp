#include "sensors/joint_state.h"

#include <cmath>

#include <gtest/gtest.h>

namespace tether::sim {
namespace {

const std::vector<uav::Joint> kJoints = {{"yaw", {}, {0, 0, 1}, -1, 1, 1},
                                         {"pitch", {}, {0, 1, 0}, -1, 1, 1}};
const std::vector<double> kAngles_rad = {0.25, -0.5};

MeasurementKey key_of(std::uint64_t index) {
  return {7, "uav1", "joint_state", index, SimTime(std::chrono::seconds(3))};
}

TEST(JointState, IsTheAnglesOfAllJoints) {
  const auto sample = measure_joint_state({}, kJoints, kAngles_rad, key_of(5));
  EXPECT_EQ(sample.sampled_at, SimTime(std::chrono::seconds(3)));
  EXPECT_EQ(sample.index, 5u);
  EXPECT_EQ(sample.angles_rad, kAngles_rad);
}

TEST(JointState, HasNoiseOfItsOwnForEachJoint) {
  JointStateModel model;
  model.angle_rad.stddev = 0.01;
  constexpr std::uint64_t kCount = 4000;
  double sum = 0.0, squares = 0.0, product = 0.0;
  for (std::uint64_t i = 0; i < kCount; ++i) {
    const auto sample = measure_joint_state(model, kJoints, kAngles_rad, key_of(i));
    const double yaw = sample.angles_rad[0] - 0.25, pitch = sample.angles_rad[1] + 0.5;
    sum += yaw;
    squares += yaw * yaw;
    product += yaw * pitch;
  }
  EXPECT_NEAR(sum / kCount, 0.0, 1e-3);
  EXPECT_NEAR(std::sqrt(squares / kCount), 0.01, 5e-4);
  EXPECT_NEAR(product / kCount, 0.0, 1e-5);
}

}  // namespace
}  // namespace tether::sim
