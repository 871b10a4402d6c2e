#include "sample_timing.h"

#include <gtest/gtest.h>

#include <tether/timing/timing.h>

namespace tether::timing {
namespace {

TEST(StageTable, HasQuantilesAndShares) {
  Timing timing = sample_timing(1, 0);
  for (int i = 1; i <= 101; ++i)
    timing.runs[0].calls.push_back(
        {"command",
         {{"detect, \"fine\"", Duration(i * 1'000'000)}, {"decide", Duration(51'000'000)}}});
  timing.runs[0].calls.push_back({"finish", {{"once", Duration(0)}}});
  const auto rows = stage_rows(timing);
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[2].stage, "once");
  EXPECT_NEAR(rows[0].share, 0.5, 1e-12);
  const StageRow& detect = rows[0].stage == "decide" ? rows[1] : rows[0];
  EXPECT_EQ(detect.count, 101u);
  EXPECT_DOUBLE_EQ(detect.median_s, 0.051);
  EXPECT_DOUBLE_EQ(detect.p95_s, 0.096);
  EXPECT_DOUBLE_EQ(detect.p99_s, 0.1);
  EXPECT_DOUBLE_EQ(detect.worst_s, 0.101);
  EXPECT_EQ(warnings(rows).size(), 1u);
  EXPECT_NE(to_text(rows).find("51.000"), std::string::npos);
}

}  // namespace
}  // namespace tether::timing
