#include "support/trials.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// What a program does that its execution time leaves out, or counts twice (docs/adr/0064).
namespace tether::system_test {
namespace {

using testing::IsEmpty;

class Unseen : public testing::Test {
 protected:
  nlohmann::json doubts_of(const std::string& mode,
                           const std::vector<Substitution>& substitutions = {}) {
    const auto scenario = write_hover_scenario(folder_.path(), mode, substitutions);
    const Output flown = run(tether({"run", scenario, "--force", "--out", folder_ / "out"}));
    const auto this_run = read_result(folder_ / "out").at("this_run");
    nlohmann::json doubts = nlohmann::json::array();
    for (const auto& doubt : this_run.value("doubts", nlohmann::json::array()))
      if (doubt.at("kind") != "busy_machine") doubts.push_back(doubt);
    EXPECT_EQ(flown.code, doubts.empty() ? 0 : 3) << flown.err;
    return doubts;
  }
  void expect(const std::string& kind, double least, double most, const nlohmann::json& doubts) {
    ASSERT_EQ(doubts.size(), 1u) << doubts;
    EXPECT_EQ(doubts[0].at("kind"), kind);
    EXPECT_EQ(doubts[0].at("subject"), "uav1");
    EXPECT_THAT(doubts[0].at("amount").get<double>(),
                testing::AllOf(testing::Ge(least), testing::Le(most)));
  }

  TempFolder folder_;
};

// It waits 0.36 s.
TEST_F(Unseen, WaitingIsFoundInEveryFormUnderEveryClock) {
  expect("unseen_wait", 0.28, 0.5, doubts_of("wait"));
  expect("unseen_wait", 0.28, 0.5, doubts_of("wait", {kScripted}));
  EXPECT_THAT(doubts_of("wait", {kWall}), IsEmpty());
}

TEST_F(Unseen, ThreadsThatComputeTogetherAreFound) {
  expect("parallel_threads", 1.5, 2.1, doubts_of("together"));
  EXPECT_THAT(doubts_of("in_turn"), IsEmpty());
}

TEST_F(Unseen, LoadIsNoWaitingAndHidesNone) {
  const Spinner spinners[3];
  expect("unseen_wait", 0.25, 0.7, doubts_of("wait"));
  expect("parallel_threads", 1.4, 2.1, doubts_of("together"));
  EXPECT_THAT(doubts_of("in_turn"), IsEmpty());
  EXPECT_THAT(doubts_of("good"), IsEmpty());
  EXPECT_THAT(doubts_of("look"), IsEmpty());
}

}  // namespace
}  // namespace tether::system_test
