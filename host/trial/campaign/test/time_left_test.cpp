#include "time_left.h"

#include <gtest/gtest.h>

#include <tether/campaign_testing/sample_campaign.h>

namespace tether::campaign {
namespace {

using std::chrono::seconds;

class TimeLeft : public testing::Test {
 protected:
  std::vector<Batch> batches(int jobs) const {
    std::vector<const TrialPlan*> plans;
    for (const TrialPlan& plan : plans_) plans.push_back(&plan);
    return make_batches(plans, jobs);
  }
  ScratchFolder scratch_;
  scenario::Campaign campaign_ = make_campaign(scratch_);
  std::vector<TrialPlan> plans_ = plan_trials(campaign_, "out");
};

TEST_F(TimeLeft, DividesByTheJobsOfEachBatch) {
  EXPECT_FALSE(estimate_time_left({}, batches(2))) << "unknown at the start";
  // One trial each of host, target and the free-running one, of three.
  const std::vector<FinishedTrial> finished = {
      {&plans_[0], seconds(2)}, {&plans_[1], seconds(6)}, {&plans_[2], seconds(10)}};
  EXPECT_EQ(estimate_time_left(finished, batches(1)), seconds(4 + 12 + 20));
  const auto two = batches(2);
  ASSERT_EQ(two.size(), 2u);
  EXPECT_EQ(estimate_time_left(finished, two), seconds((4 + 12) / 2) + seconds(20) / two[1].jobs);
}

}  // namespace
}  // namespace tether::campaign
