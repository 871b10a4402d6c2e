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

}  // namespace
}  // namespace tether::uav
