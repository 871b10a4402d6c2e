#include "coordinator_fixture.h"

#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// Timestamps of a SUT that measures its own time are checked against the host clock. One that is
/// ahead ends the run.
namespace tether::coordinator {
namespace {

using computer::ClockKind;
using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::HasSubstr;

class ClockPlausibility : public CoordinatorTest {
 protected:
  /// The host clock advances by a millisecond per reading, and by some tens for a whole script.
  RunReport fly(ClockKind clock, double factor, ScriptedServer::Script script) {
    make();
    link::Hello with_clock = hello("", clock);
    with_clock.clock.factor = factor;
    peer_ = server_->add_sut(with_clock, std::move(script));
    return run();
  }
  link::PeerId peer_ = 0;
};

TEST_F(ClockPlausibility, ARequestAheadOfTheHostClockEndsTheRun) {
  const RunReport report = fly(ClockKind::kWall, 1.0, {sleep(hours(1), seconds(1))});
  EXPECT_EQ(report.end, RunEnd::kSutLost);
  EXPECT_THAT(report.reason, testing::MatchesRegex(
                                 ".*timestamp ET 3600.000000 s, which is 3599.9[0-9]* s ahead of "
                                 "the host clock .resumed at ET 0.000000 s."));
  EXPECT_EQ(refusal(peer_).reason, link::Refusal::Reason::kBadRequest);
  EXPECT_LT(report.st, st_ms(100));
  EXPECT_TRUE(recorder_.interactions.empty());
  EXPECT_TRUE(recorder_.footer);
}

TEST_F(ClockPlausibility, ProgressAheadOfTheHostClockEndsTheRun) {
  make();
  const auto peer = server_->add_sut(hello("", ClockKind::kWall), {});
  server_->deliver(peer, link::Progress{ExecTime(hours(10))});
  const RunReport report = run();
  EXPECT_EQ(report.end, RunEnd::kSutLost);
  EXPECT_THAT(report.reason, HasSubstr("36000.000000 s"));
  EXPECT_LT(report.st, st_ms(100));
}

// The call of one second takes more than two seconds of the host clock. Child processes compute
// meanwhile, which a CPU clock adds afterwards.
TEST_F(ClockPlausibility, OnlyChildrenComputeDuringACall) {
  const struct {
    ClockKind clock;
    RunEnd end;
  } cases[] = {{ClockKind::kWall, RunEnd::kSutLost}, {ClockKind::kCpu, RunEnd::kFinished}};
  tick_ = milliseconds(10);
  cores_ = 1;
  options_.real_time_factor = 0.5;
  for (const auto& c : cases) {
    const RunReport report = fly(
        c.clock, 1.0,
        {sleep(Duration(0), seconds(1)), sleep(seconds(2), seconds(1)), finish(milliseconds(1))});
    EXPECT_EQ(report.end, c.end) << report.reason;
    EXPECT_GT(report.wall, seconds(2));
    const bool is_lost = c.end == RunEnd::kSutLost;
    EXPECT_EQ(report.reason.find("resumed at ET 1.000000 s") != std::string::npos, is_lost);
  }
}

// CPU time of all cores together grows faster than the host clock, but not without limit. Of an
// unknown machine, many cores are assumed. Scripted times are made up on purpose.
TEST_F(ClockPlausibility, DependsOnTheClockAndTheCores) {
  struct Case {
    ClockKind clock;
    double factor;
    int cores;
    Duration computing;
    RunEnd end;
  };
  const Case cases[] = {{ClockKind::kWall, 6.0, 0, milliseconds(15), RunEnd::kFinished},
                        {ClockKind::kCpu, 6.0, 0, milliseconds(15), RunEnd::kFinished},
                        {ClockKind::kCpu, 1.0, 2, milliseconds(20), RunEnd::kFinished},
                        {ClockKind::kCpu, 1.0, 2, milliseconds(500), RunEnd::kSutLost},
                        {ClockKind::kCpu, 50.0, 2, milliseconds(500), RunEnd::kFinished},
                        {ClockKind::kWall, 1.0, 64, milliseconds(500), RunEnd::kSutLost},
                        {ClockKind::kCpu, 1.0, 0, milliseconds(500), RunEnd::kFinished},
                        {ClockKind::kCpu, 1.0, 0, hours(1), RunEnd::kSutLost},
                        {ClockKind::kScripted, 1.0, 0, seconds(60), RunEnd::kFinished}};
  for (const Case& c : cases) {
    cores_ = c.cores;
    const RunReport report =
        fly(c.clock, c.factor, {sleep(c.computing, seconds(1)), finish(milliseconds(4))});
    EXPECT_EQ(report.end, c.end) << report.reason;
    EXPECT_EQ(recorder_.header.suts[0].cores, c.clock == ClockKind::kCpu ? c.cores : 0);
  }
}

TEST_F(ClockPlausibility, ASutThatCannotMeasureItsTimeEndsTheRun) {
  make();
  const auto peer = server_->add_sut(hello("", ClockKind::kCpu), {});
  server_->deliver(peer, link::Refusal{link::Refusal::Reason::kBadRequest, "SIGCHLD\nis ignored"});
  const RunReport report = run();
  EXPECT_EQ(report.end, RunEnd::kSutLost);
  EXPECT_THAT(report.reason, HasSubstr("ended the run: SIGCHLD?is ignored"));
}

TEST_F(ClockPlausibility, IsNotCheckedInFreeRunning) {
  set_free_running(1.0);
  EXPECT_EQ(fly(ClockKind::kWall, 1.0, {finish(hours(1))}).end, RunEnd::kFinished);
}

}  // namespace
}  // namespace tether::coordinator
