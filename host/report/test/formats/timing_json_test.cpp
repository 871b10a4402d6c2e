#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <tether/report/report.h>

namespace tether::report {
namespace {

timing::Timing timing_of(int detect_ms) {
  timing::Timing timing;
  timing.scenario = "face_anchor";
  timing.condition = "target";
  timing.board = "pi";
  timing.runs = {{"uav1", 1, {}}};
  for (int i = 0; i < 30; ++i)
    timing.runs[0].calls.push_back({"command", {{"detect", std::chrono::milliseconds(detect_ms)}}});
  return timing;
}

TEST(TimingJson, HasTheStagesInSeconds) {
  const auto json = nlohmann::json::parse(timing_json(timing_of(20)));
  EXPECT_EQ(json["schema"], 1);
  EXPECT_EQ(json["condition"], "target");
  EXPECT_EQ(json["target"], "pi");
  EXPECT_EQ(json["stages"][0]["stage"], "detect");
  EXPECT_EQ(json["stages"][0]["count"], 30);
  EXPECT_EQ(json["stages"][0]["median_s"], 0.02);
  EXPECT_EQ(json["stages"][0]["share"], 1.0);
  EXPECT_TRUE(json["warnings"].empty());
}

TEST(TimingJson, SaysWhichStagesAreBeyondTheLimit) {
  const timing::Timing now = timing_of(24), before = timing_of(20);
  const timing::Comparison change = timing::compare(now, before);
  for (const auto& [limit, is_beyond] : {std::pair(0.1, true), std::pair(0.3, false)}) {
    const auto json = nlohmann::json::parse(change_json(now, before, change, limit));
    EXPECT_EQ(json["limit"], limit);
    EXPECT_EQ(json["is_beyond_limit"], is_beyond);
    EXPECT_EQ(json["stages"][0]["is_beyond_limit"], is_beyond);
    EXPECT_NEAR(json["stages"][0]["change"], 0.2, 1e-9);
  }
  const auto json = nlohmann::json::parse(change_json(now, before, change, std::nullopt));
  EXPECT_TRUE(json["limit"].is_null());
  EXPECT_EQ(json["is_beyond_limit"], false);
}

}  // namespace
}  // namespace tether::report
