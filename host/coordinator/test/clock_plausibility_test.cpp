#include "coordinator_fixture.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// Whoever stamps by a clock of its own is watched by the coordinator's: what is ahead of all that
/// can have gone by ends the run, and says by how much.
namespace tether::coordinator {
namespace {

using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::HasSubstr;

class HonestyTest : public CoordinatorTest {
 protected:
  /// The fixture's clock moves a millisecond per reading; a script runs through in some tens.
  RunReport fly(link::ClockKind clock, double factor, ScriptedServer::Script script) {
    make();
    link::Hello introduction = hello();
    introduction.clock = clock;
    introduction.cpu_factor = factor;
    peer_ = server_->add_sut(introduction, std::move(script));
    return coordinator_->run(*server_, hooks_);
  }
  link::PeerId peer_ = 0;
};

TEST_F(HonestyTest, ARequestAheadOfOurClockEndsTheRunWithItsSize) {
  const RunReport report = fly(link::ClockKind::kWall, 1.0, {sleep(hours(1), seconds(1))});
  EXPECT_EQ(report.end, RunEnd::kSutLost);
  EXPECT_THAT(report.reason, testing::MatchesRegex(
                                 "the SUT of UAV \"uav0\" sent a time stamp of ET 3600.000000 s, "
                                 "which is 3599.9.* s ahead: since it went on at ET 0.000000 s.*"));
  EXPECT_EQ(refusal(peer_).reason, link::Refusal::Reason::kBadRequest);
  EXPECT_LT(report.st, st_ms(100));
  EXPECT_TRUE(recorder_.interactions.empty());
  EXPECT_TRUE(recorder_.footer);
}

TEST_F(HonestyTest, WaitingForAReplyEarnsNothing) {
  tick_ = milliseconds(10);  // the hold of a second takes longer than that on our clock
  options_.real_time_factor = 0.5;
  const RunReport report = fly(link::ClockKind::kWall, 1.0,
                               {sleep(Duration(0), seconds(1)), sleep(seconds(2), seconds(1))});
  EXPECT_EQ(report.end, RunEnd::kSutLost);
  EXPECT_GT(report.wall, seconds(2));
  EXPECT_THAT(report.reason, HasSubstr("went on at ET 1.000000 s"));
}

TEST_F(HonestyTest, AnHonestSutIsNotDoubted) {
  for (const auto clock : {link::ClockKind::kWall, link::ClockKind::kCpu}) {
    const RunReport report = fly(clock, 6.0,
                                 {sleep(milliseconds(5), seconds(1)), read(milliseconds(3), kRange),
                                  finish(milliseconds(4))});
    EXPECT_EQ(report.end, RunEnd::kFinished) << report.reason;
  }
}

// All cores of a machine together make more CPU time than time goes by, but not any amount of it.
// By the fixture's clock, a script's first request comes after some ten milliseconds.
TEST_F(HonestyTest, CpuTimeMayGrowOnAllCoresOfTheMachineAtOnce) {
  cores_ = 2;
  EXPECT_EQ(fly(link::ClockKind::kCpu, 1.0, {finish(milliseconds(20))}).end, RunEnd::kFinished);
  EXPECT_EQ(recorder_.header.suts[0].cores, 2);
  const RunReport report = fly(link::ClockKind::kCpu, 1.0, {finish(milliseconds(500))});
  EXPECT_EQ(report.end, RunEnd::kSutLost);
  EXPECT_THAT(report.reason, HasSubstr("0.4"));
  EXPECT_THAT(report.reason, HasSubstr("than this machine's clock shows for each of 2 cores"));
  EXPECT_EQ(fly(link::ClockKind::kCpu, 50.0, {finish(milliseconds(500))}).end, RunEnd::kFinished);
}

// A wall clock goes on as fast on any number of cores.
TEST_F(HonestyTest, CoresMakeNoWallClockFaster) {
  cores_ = 64;
  const RunReport report = fly(link::ClockKind::kWall, 1.0, {finish(milliseconds(500))});
  EXPECT_EQ(report.end, RunEnd::kSutLost);
  EXPECT_THAT(report.reason, testing::EndsWith("than this machine's clock shows"));
  EXPECT_EQ(recorder_.header.suts[0].cores, 0);
}

TEST_F(HonestyTest, OfAnUnknownMachineManyCoresAreBelieved) {
  EXPECT_EQ(fly(link::ClockKind::kCpu, 1.0, {finish(milliseconds(500))}).end, RunEnd::kFinished);
  EXPECT_EQ(fly(link::ClockKind::kCpu, 1.0, {finish(hours(1))}).end, RunEnd::kSutLost);
}

// Its times are made up by purpose, and the record names it.
TEST_F(HonestyTest, AScriptedClockIsNotDoubted) {
  EXPECT_EQ(fly(link::ClockKind::kScripted, 1.0, {finish(seconds(60))}).end, RunEnd::kFinished);
}

TEST_F(HonestyTest, ProgressAheadOfOurClockEndsTheRun) {
  make();
  link::Hello introduction = hello();
  introduction.clock = link::ClockKind::kWall;
  const auto peer = server_->add_sut(introduction, {});
  server_->deliver(peer, link::Progress{ExecTime(hours(10))});
  const RunReport report = coordinator_->run(*server_);
  EXPECT_EQ(report.end, RunEnd::kSutLost);
  EXPECT_THAT(report.reason, HasSubstr("sent a time stamp of ET 36000.000000 s"));
  EXPECT_LT(report.st, st_ms(100));
}

// Nothing is tied to ET there.
TEST_F(HonestyTest, InFreeRunningNobodyIsDoubted) {
  options_.policy = sync::SyncPolicy::kFreeRunning;
  options_.real_time_factor = 1.0;
  EXPECT_EQ(fly(link::ClockKind::kWall, 1.0, {finish(hours(1))}).end, RunEnd::kFinished);
}

TEST_F(HonestyTest, WhenNothingMovesTheStatusSaysWhoBlocksWhom) {
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
  const RunReport report = coordinator_->run(*server_, hooks_);
  EXPECT_THAT(first, testing::StartsWith("ST 0.005000 s: blocked on SUT \"script\" (UAV \"uav0\"), "
                                         "which has been computing for 1.0 s"));
  EXPECT_THAT(report.reason,
              HasSubstr("computing for 3.0 s without a message; last message at ET 0.005000 s"));
}

TEST_F(HonestyTest, AJoinIsAMove) {
  options_.connect_limit = seconds(3);
  make(2);
  std::optional<WallTime> came, joined, said;
  hooks_.on_status = [&](const RunStatus& status) {
    if (status.joined == 1 && !joined) joined = now_;
    if (!status.blocked.empty() && !said) said = now_;
    if (!came && now_ > WallTime(milliseconds(700))) {
      came = now_;
      server_->add_sut(hello("uav1"), {});
    }
  };
  coordinator_->run(*server_, hooks_);
  ASSERT_TRUE(joined && said);
  EXPECT_NEAR(to_seconds(*said - *joined), 1.0, 0.1);
}

TEST_F(HonestyTest, ALostSutIsNamedWithWhereItStood) {
  options_.real_time_factor = 0.5;
  make();
  const auto peer = server_->add_sut(hello(), {sleep(Duration(0), seconds(5))});
  hooks_.on_status = [&](const RunStatus& status) {
    if (status.st > st_ms(1'000)) server_->disconnect(peer);
  };
  EXPECT_THAT(coordinator_->run(*server_, hooks_).reason,
              HasSubstr("connection closed; it was waiting for its reply of ET 5.000000 s"));
}

}  // namespace
}  // namespace tether::coordinator
