#include "time_left.h"

#include <gtest/gtest.h>

#include <tether/experiment_testing/scratch.h>

namespace tether::experiment {
namespace {

using std::chrono::seconds;

class TimeLeft : public testing::Test {
 protected:
  TimeLeft() {
    for (const TrialPlan& plan : plans_) {
      (may_run_beside_others(*plan.condition) ? side_by_side_ : alone_).push_back(&plan);
    }
  }
  Scratch scratch_;
  scenario::Campaign campaign_ = make_campaign(scratch_);
  std::vector<TrialPlan> plans_ = plan_trials(campaign_, "out");
  std::vector<const TrialPlan*> side_by_side_, alone_;
};

TEST_F(TimeLeft, IsUnknownAtFirst) {
  EXPECT_FALSE(estimate_time_left({}, side_by_side_, alone_, 2));
}

TEST_F(TimeLeft, SharesOutOnlyWhatRunsSideBySide) {
  const std::vector<FinishedTrial> finished = {
      {side_by_side_[0], seconds(2)}, {side_by_side_[1], seconds(6)}, {alone_[0], seconds(10)}};
  // host: 2 × 2 s, target: 2 × 6 s, over two jobs; 2 × 10 s alone.
  EXPECT_EQ(estimate_time_left(finished, side_by_side_, alone_, 2), seconds(8 + 20));
  EXPECT_EQ(estimate_time_left(finished, side_by_side_, alone_, 1), seconds(16 + 20));
}

}  // namespace
}  // namespace tether::experiment
