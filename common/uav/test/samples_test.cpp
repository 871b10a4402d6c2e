#include <cmath>

#include <gmock/gmock.h>

#include <tether/uav/samples.h>

namespace tether::uav {
namespace {

TEST(Samples, SamplingInstantOfEachKind) {
  const SimTime t = from_ns<SimTime>(42);
  for (const Sample& sample :
       {Sample(CameraSample{t, 0, 0, 0, {}}), Sample(ImuSample{t, 0, {}, {}, {}}),
        Sample(RangeSample{t, 0, 1.0})}) {
    EXPECT_EQ(sampled_at(sample), t);
  }
}

TEST(VelocityCommand, IsValidWithinWhatAnyMultirotorCanDo) {
  EXPECT_TRUE(is_valid({}));
  EXPECT_TRUE(is_valid({{100, -100, 100}, -100}));
  const double inf = std::numeric_limits<double>::infinity();
  for (const double bad : {std::nan(""), inf, -inf, 100.1, -100.1}) {
    for (const VelocityCommand& command :
         {VelocityCommand{{bad, 0, 0}, 0}, {{0, bad, 0}, 0}, {{0, 0, bad}, 0}, {{}, bad}})
      EXPECT_FALSE(is_valid(command)) << bad;
  }
}

}  // namespace
}  // namespace tether::uav
