#include <cmath>

#include <gmock/gmock.h>

#include <tether/uav/samples.h>

namespace tether::uav {
namespace {

TEST(Samples, SamplingInstantOfEachKind) {
  const SimTime t = from_ns<SimTime>(42);
  CameraSample camera;
  camera.sampled_at = t;
  ImuSample imu;
  imu.sampled_at = t;
  RangeSample range;
  range.sampled_at = t;
  for (const Sample& sample : {Sample(camera), Sample(imu), Sample(range)}) {
    EXPECT_EQ(sampled_at(sample), t);
  }
}

TEST(VelocityCommand, ValidWithinWhatAnyMultirotorCouldDo) {
  EXPECT_TRUE(is_valid({}));
  EXPECT_TRUE(is_valid({{100, -100, 100}, -100}));
}

TEST(VelocityCommand, InvalidOutsideOrNotFinite) {
  const double nan = std::nan("");
  const double inf = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, inf, -inf, 100.1, -100.1}) {
    EXPECT_FALSE(is_valid({{bad, 0, 0}, 0})) << bad;
    EXPECT_FALSE(is_valid({{0, bad, 0}, 0})) << bad;
    EXPECT_FALSE(is_valid({{0, 0, bad}, 0})) << bad;
    EXPECT_FALSE(is_valid({{}, bad})) << bad;
  }
}

}  // namespace
}  // namespace tether::uav
