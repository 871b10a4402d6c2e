#include "trial_end.h"

#include <gtest/gtest.h>

namespace tether::runner {
namespace {

using coordinator::RunEnd;

TEST(EarlyStop, MapsToTheEndOfARun) {
  const auto end_for = [](StopCause cause) { return to_run_end({cause, "why"}).how; };
  EXPECT_EQ(end_for(StopCause::kInterrupted), RunEnd::kInterrupted);
  EXPECT_EQ(end_for(StopCause::kSimulatorLost), RunEnd::kSimulatorLost);
  EXPECT_EQ(end_for(StopCause::kBoardLost), RunEnd::kSutLost);
  EXPECT_EQ(end_for(StopCause::kSutEnded), RunEnd::kSutLost);
  EXPECT_EQ(to_run_end({StopCause::kSutEnded, "why"}).reason, "why");
}

TEST(TrialEnd, TellsWhichCausesToLookFor) {
  struct Case {
    RunEnd end;
    bool began, joined;
    std::optional<StopCause> cause;
    bool may_have_stopped, is_unexplained, lacks;
  };
  const Case cases[] = {
      {RunEnd::kFinished, true, true, std::nullopt, false, false, false},
      {RunEnd::kSutHung, true, true, std::nullopt, true, false, false},
      {RunEnd::kSutLost, true, true, std::nullopt, false, true, false},
      {RunEnd::kSutLost, false, true, std::nullopt, true, true, false},
      {RunEnd::kSutLost, false, false, std::nullopt, true, true, true},
      {RunEnd::kSutLost, true, true, StopCause::kBoardLost, false, false, false},
      {RunEnd::kSutLost, false, false, StopCause::kSutEnded, true, false, false},
      {RunEnd::kInterrupted, false, false, StopCause::kInterrupted, false, false, false}};
  for (const Case& c : cases) {
    SCOPED_TRACE(name(c.end));
    TrialEnd end{{}, c.cause};
    end.report.end = c.end;
    end.report.began = c.began;
    end.report.suts = {{"uav1", c.joined ? "fly" : "", std::nullopt, ExecTime()}};
    EXPECT_EQ(may_have_stopped_sut(end), c.may_have_stopped);
    EXPECT_EQ(has_unexplained_sut(end), c.is_unexplained);
    EXPECT_EQ(lacks_sut(end), c.lacks);
  }
}

TEST(TrialEnd, NamesTheCauseOfALostSutBeforeItsConnection) {
  coordinator::RunReport report;
  report.reason = "lost the SUT: it was computing; it closed";
  report.causes_at = 12;
  EXPECT_EQ(with_causes(report, "; it crashed"),
            "lost the SUT: it crashed; it was computing; it closed");
  EXPECT_EQ(with_causes(report, ""), report.reason);
  report.causes_at = report.reason.size();
  EXPECT_EQ(with_causes(report, "; it crashed"), report.reason + "; it crashed");
}

}  // namespace
}  // namespace tether::runner
