#include "coordinator_fixture.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// Timestamps of a SUT with a clock of its own are checked against the host clock. One that is
/// ahead ends the run.
namespace tether::coordinator {
namespace {

using link::ClockKind;
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
    with_clock.cpu_factor = factor;
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

TEST_F(ClockPlausibility, TimeInACallDoesNotCount) {
  tick_ = milliseconds(10);  // the call of one second takes more than two seconds of the host clock
  options_.real_time_factor = 0.5;
  const RunReport report =
      fly(ClockKind::kWall, 1.0, {sleep(Duration(0), seconds(1)), sleep(seconds(2), seconds(1))});
  EXPECT_EQ(report.end, RunEnd::kSutLost);
  EXPECT_GT(report.wall, seconds(2));
  EXPECT_THAT(report.reason, HasSubstr("resumed at ET 1.000000 s"));
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

TEST_F(ClockPlausibility, IsNotCheckedInFreeRunning) {
  set_free_running(1.0);
  EXPECT_EQ(fly(ClockKind::kWall, 1.0, {finish(hours(1))}).end, RunEnd::kFinished);
}

// ---- Status and messages while nothing moves.

TEST_F(CoordinatorTest, TheStatusNamesTheSutThatBlocksTheRun) {
  options_.hang_limit = seconds(3);
  make();
  server_->add_sut(hello(), {sleep(Duration(0), milliseconds(5))});
  std::string first;
  SimTime st_before{};
  hooks_.on_status = [&](const RunStatus& status) {
    if (first.empty() && !status.blocked.empty()) {
      first = status.blocked;
      EXPECT_EQ(status.st, st_before);
    }
    st_before = status.st;
  };
  const RunReport report = run();
  EXPECT_THAT(first, HasSubstr("(UAV \"uav0\"), which has been computing for 1.0 s"));
  EXPECT_THAT(report.reason, HasSubstr("3.0 s without a message; last message at ET 0.005000 s"));
}

TEST_F(CoordinatorTest, AJoinCountsAsAMove) {
  options_.connect_limit = seconds(3);
  make(2);
  std::optional<WallTime> added, joined, reported;
  hooks_.on_status = [&](const RunStatus& status) {
    if (status.joined == 1 && !joined) joined = now_;
    if (!status.blocked.empty() && !reported) reported = now_;
    if (!added && now_ > WallTime(milliseconds(700))) {
      added = now_;
      add_silent(false, "uav1");
    }
  };
  run();
  ASSERT_TRUE(joined && reported);
  EXPECT_NEAR(to_seconds(*reported - *joined), 1.0, 0.1);
}

TEST_F(CoordinatorTest, ReportsTheStateOfALostSut) {
  options_.real_time_factor = 0.5;
  make();
  const auto peer = server_->add_sut(hello(), {sleep(Duration(0), seconds(5))});
  hooks_.on_status = [&](const RunStatus& status) {
    if (status.st > st_ms(1'000)) server_->disconnect(peer);
  };
  EXPECT_THAT(run().reason, HasSubstr("waiting for its reply at ET 5.000000 s"));
}

}  // namespace
}  // namespace tether::coordinator
