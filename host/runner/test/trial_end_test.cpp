#include "trial_end.h"

#include <gtest/gtest.h>

namespace tether::runner {
namespace {

using coordinator::RunEnd;

/// Of a run with one SUT; without a name, it did not join.
TrialEnd end_of(RunEnd end, bool began, const std::string& sut = "fly",
                std::optional<StopCause> cause = std::nullopt) {
  coordinator::RunReport report;
  report.end = end;
  report.began = began;
  report.suts = {{"uav1", sut, std::nullopt, ExecTime()}};
  return {report, cause};
}

TEST(EarlyStop, MapsToTheEndOfARun) {
  const auto end_for = [](StopCause cause) { return to_run_end({cause, "why"}).first; };
  EXPECT_EQ(end_for(StopCause::kInterrupted), RunEnd::kInterrupted);
  EXPECT_EQ(end_for(StopCause::kSimulatorLost), RunEnd::kSimulatorLost);
  EXPECT_EQ(end_for(StopCause::kBoardLost), RunEnd::kSutLost);
  EXPECT_EQ(end_for(StopCause::kSutEnded), RunEnd::kSutLost);
  EXPECT_EQ(to_run_end({StopCause::kSutEnded, "why"}).second, "why");
}

TEST(TrialEnd, MayHaveAStoppedSutIfOneWasSilent) {
  EXPECT_TRUE(may_have_stopped_sut(end_of(RunEnd::kSutHung, true)));
  EXPECT_TRUE(may_have_stopped_sut(end_of(RunEnd::kSutLost, false)));
  EXPECT_FALSE(may_have_stopped_sut(end_of(RunEnd::kSutLost, true)));
  EXPECT_FALSE(may_have_stopped_sut(end_of(RunEnd::kFinished, true)));
  EXPECT_FALSE(may_have_stopped_sut(end_of(RunEnd::kInterrupted, false)));
}

TEST(TrialEnd, HasAnUnexplainedSutUnlessTheRunnerEndedTheRun) {
  EXPECT_TRUE(has_unexplained_sut(end_of(RunEnd::kSutLost, true)));
  EXPECT_TRUE(has_unexplained_sut(end_of(RunEnd::kSutLost, false)));
  for (const StopCause cause : {StopCause::kBoardLost, StopCause::kSutEnded})
    EXPECT_FALSE(has_unexplained_sut(end_of(RunEnd::kSutLost, true, "fly", cause)));
  EXPECT_FALSE(has_unexplained_sut(end_of(RunEnd::kSutHung, true)));
}

TEST(TrialEnd, LacksASutThatDidNotJoin) {
  EXPECT_TRUE(lacks_sut(end_of(RunEnd::kSutLost, false, "")));
  EXPECT_FALSE(lacks_sut(end_of(RunEnd::kSutLost, false, "fly")));
  EXPECT_FALSE(lacks_sut(end_of(RunEnd::kSutLost, true, "")));
  EXPECT_FALSE(lacks_sut(end_of(RunEnd::kSutLost, false, "", StopCause::kSutEnded)));
  EXPECT_FALSE(lacks_sut(end_of(RunEnd::kInterrupted, false, "", StopCause::kInterrupted)));
}

}  // namespace
}  // namespace tether::runner
