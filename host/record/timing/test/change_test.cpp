#include "sample_timing.h"

#include <gtest/gtest.h>

#include <tether/timing/timing.h>

namespace tether::timing {
namespace {

const StageChange* find(const Comparison& comparison, const std::string& stage) {
  for (const StageChange& change : comparison.stages)
    if (change.stage == stage) return &change;
  return nullptr;
}

TEST(Change, SeesAStageThatBecameSlower) {
  Timing now = sample_timing(10, 30, 96e6);
  for (auto& run : now.runs) run.seed += 100;
  const Comparison comparison = compare(now, sample_timing(10, 30, 80e6));
  const StageChange* const detect = find(comparison, "detect");
  ASSERT_NE(detect, nullptr);
  EXPECT_NEAR(detect->change, 0.2, 0.03);
  EXPECT_LT(detect->low, 0.2);
  EXPECT_GT(detect->low, 0.1);
  EXPECT_GT(detect->high, 0.19);
  EXPECT_EQ(find(comparison, "command to camera"), nullptr);  // hardly any time
  EXPECT_TRUE(is_beyond(comparison, 0.1));
  EXPECT_FALSE(is_beyond(comparison, 0.3));
  const double limit = 0.5;
  EXPECT_NE(to_text(comparison, &limit).find("margin left 1.2"), std::string::npos);
}

TEST(Change, NamesStagesThatOnlyOneHas) {
  Timing now = sample_timing(), before = now;
  before.runs[0].calls[0].stages.push_back({"track", Duration(50'000'000)});
  now.runs[0].calls[0].stages.push_back({"learn", Duration(50'000'000)});
  const Comparison comparison = compare(now, before);
  EXPECT_EQ(comparison.added, std::vector<std::string>{"learn"});
  EXPECT_EQ(comparison.removed, std::vector<std::string>{"track"});
  ASSERT_NE(find(comparison, "detect"), nullptr);
  EXPECT_EQ(find(comparison, "detect")->change, 0.0);
  EXPECT_EQ(find(comparison, "detect")->few, 0u);
}

TEST(Change, HasTheDoubtBesideItsFigures) {
  Comparison comparison = compare(sample_timing(), sample_timing());
  comparison.doubt = "Busy machine.";
  EXPECT_NE(to_text(comparison, nullptr).find("]\nBusy machine.\n"), std::string::npos);
}

}  // namespace
}  // namespace tether::timing
