#include "sample_record.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/report/plots.h>

namespace tether::report {
namespace {

using testing::HasSubstr;

TEST(MotionPlot, HasTheHeightAndTheSpeedOfItsUav) {
  record::Record record;
  for (const int i : {0, 1, 2}) {
    record::GroundTruth& truth = record.ground_truth.emplace_back().message;
    truth.uav = i == 1 ? "uav2" : "uav1";
    truth.at = SimTime(std::chrono::seconds(i));
    truth.p_WB_m[2] = 1.5 + i;
    truth.v_WB_m_s[0] = 3.0;
    truth.v_WB_m_s[2] = -4.0;
  }
  const auto plot = motion_plot({&record, "uav1", "target", 0});
  ASSERT_TRUE(plot);
  EXPECT_THAT(plot->script, HasSubstr("$height << END\n0 1.5\n2 3.5\nEND\n"));
  EXPECT_THAT(plot->script, HasSubstr("$speed << END\n0 5\n2 5\nEND\n"));
  EXPECT_FALSE(motion_plot({&record, "uav2", "target", 0})) << "one point is no curve";
}

}  // namespace
}  // namespace tether::report
