#include "sessions/watchdog.h"

#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::coordinator {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::HasSubstr;

WallTime at(Duration t) {
  return WallTime{} + t;
}
ExecTime et_ms(std::int64_t value) {
  return ExecTime(milliseconds(value));
}
constexpr SimTime kSt{milliseconds(1200)};

Party computing(const std::string& uav, Duration silence, ExecTime bound = ExecTime{}) {
  return {
      .sut = "sut of " + uav, .uav = uav, .computing = true, .bound = bound, .silence = silence};
}
Party held(const std::string& uav, ExecTime reply_at, Duration silence = Duration(0)) {
  return {.sut = "sut of " + uav,
          .uav = uav,
          .bound = reply_at,
          .silence = silence,
          .reply_at = reply_at};
}
Party absent(const std::string& uav, Duration waited) {
  return {.sut = "", .uav = uav, .joined = false, .bound = {}, .silence = waited};
}

/// For two SUTs, with limits of 60 s of ST, 5 s to connect, and 3 s without a sign of life.
Watchdog make() {
  return {{SimTime(seconds(60)), seconds(5), seconds(3)}, 2, WallTime{}};
}

TEST(Watchdog, EndsARunAtItsLimitOfSt) {
  const Watchdog watchdog = make();
  EXPECT_FALSE(watchdog.over_time(SimTime(seconds(60) - milliseconds(1))));
  EXPECT_EQ(watchdog.over_time(SimTime(seconds(60)))->how, RunEnd::kTimeLimit);
}

TEST(Watchdog, ASutThatDoesNotJoinInTimeIsLost) {
  const Watchdog watchdog = make();
  const Party joined = computing("a", seconds(90));
  EXPECT_FALSE(watchdog.overdue({joined, absent("b", seconds(5))}, kSt));
  const auto end = watchdog.overdue({joined, absent("b", milliseconds(5'001))}, kSt);
  ASSERT_TRUE(end);
  EXPECT_EQ(end->how, RunEnd::kSutLost);
  EXPECT_THAT(end->reason, HasSubstr("\"b\""));
}

TEST(Watchdog, ASutThatComputesWithoutASignOfLifeIsHung) {
  Watchdog watchdog = make();
  watchdog.begin(WallTime{});
  EXPECT_FALSE(
      watchdog.overdue({computing("a", seconds(3)), held("b", et_ms(1300), seconds(9))}, kSt));
  const auto end = watchdog.overdue({computing("a", seconds(0)), computing("b", seconds(4))}, kSt);
  ASSERT_TRUE(end);
  EXPECT_EQ(end->how, RunEnd::kSutHung);
  EXPECT_THAT(end->reason, HasSubstr("\"b\""));
}

TEST(Watchdog, CountsSilenceFromTheLastSignOfLife) {
  Watchdog watchdog = make();
  watchdog.heard(1, at(seconds(2)));
  EXPECT_EQ(watchdog.silence(0, at(seconds(3))), seconds(3));
  EXPECT_EQ(watchdog.silence(1, at(seconds(3))), seconds(1));
  watchdog.begin(at(seconds(3)));
  EXPECT_EQ(watchdog.silence(0, at(seconds(3))), seconds(0));
}

TEST(Watchdog, IsDueEvery20Milliseconds) {
  Watchdog watchdog = make();
  EXPECT_FALSE(watchdog.is_due(at(milliseconds(19))));
  EXPECT_TRUE(watchdog.is_due(at(milliseconds(20))));
  EXPECT_FALSE(watchdog.is_due(at(milliseconds(39))));
}

TEST(Watchdog, DoesNotCountTimeWithoutTurns) {
  Watchdog watchdog = make();
  ASSERT_TRUE(watchdog.is_due(at(milliseconds(500))));
  watchdog.heard(1, at(milliseconds(900)));
  const WallTime now = at(milliseconds(60'500));  // of the 60 s, one second counts
  ASSERT_TRUE(watchdog.is_due(now));
  EXPECT_EQ(watchdog.silence(0, now), milliseconds(1'500));
  EXPECT_EQ(watchdog.silence(1, now), milliseconds(600));
  EXPECT_NE(watchdog.blocked({absent("a", seconds(1))}, kSt, now), "");
}

TEST(Watchdog, ReportsTheBlockingSutAfterASecondWithoutAMove) {
  Watchdog watchdog = make();
  watchdog.begin(WallTime{});
  watchdog.moved(at(seconds(7)));
  const std::vector<Party> parties{computing("a", seconds(1))};
  EXPECT_EQ(watchdog.blocked(parties, kSt, at(milliseconds(7'999))), "");
  EXPECT_EQ(watchdog.blocked(parties, kSt, at(seconds(8))), describe_blocking(kSt, parties));
  EXPECT_EQ(watchdog.blocked({computing("a", milliseconds(999))}, kSt, at(seconds(8))),
            describe_blocking(kSt, {computing("a", milliseconds(999))}));
  Party counted = computing("a", milliseconds(999));
  counted.counted = true;
  EXPECT_EQ(watchdog.blocked({counted}, kSt, at(seconds(8))), "");
  counted.silence = seconds(1);
  EXPECT_NE(watchdog.blocked({counted}, kSt, at(seconds(8))), "");
}

TEST(Watchdog, NamesNoBlockingSutInFreeRunning) {
  Watchdog watchdog = make();
  watchdog.begin(WallTime{});
  Party free = computing("a", seconds(4));
  free.bound.reset();
  EXPECT_EQ(watchdog.blocked({free}, kSt, at(seconds(8))), "");
  EXPECT_EQ(watchdog.overdue({free}, kSt)->reason,
            "SUT \"sut of a\" of UAV \"a\" timed out: no message for 3 s (hang_limit_s)");
}

TEST(Watchdog, ReportsSutsThatHaveNotJoinedBeforeTheRun) {
  const Watchdog watchdog = make();
  const auto blocked = [&](const Party& first) {
    return watchdog.blocked({first, absent("b", milliseconds(1040))}, kSt, at(seconds(2)));
  };
  EXPECT_EQ(blocked(computing("a", seconds(9))),
            "waiting for the SUT of \"b\" to connect (1.0 s so far)");
  EXPECT_EQ(watchdog.blocked({absent("a", milliseconds(999))}, kSt, at(seconds(2))), "");
  EXPECT_EQ(blocked(absent("a", milliseconds(2500))),
            "waiting for the SUTs of \"a\", \"b\" to connect (2.5 s so far)");
}

TEST(DescribeBlocking, NamesTheComputingSutWithTheSmallestEtAndThoseThatWait) {
  const Party blocker = computing("b", milliseconds(1500), et_ms(1200));
  const std::string blocked =
      "blocked on SUT \"sut of b\" (UAV \"b\"), which has been computing for 1.5 s without a "
      "message; last message at ET 1.200000 s";
  EXPECT_EQ(describe_blocking(kSt, {computing("a", milliseconds(10), et_ms(1300)), blocker}),
            "ST 1.200000 s: " + blocked);
  EXPECT_EQ(
      describe_blocking(kSt, {held("a", et_ms(1250)), blocker, held("c", et_ms(1300))}),
      "ST 1.200000 s (UAV \"a\" waits for its reply at ET 1.250000 s, UAV \"c\" waits for its "
      "reply at ET 1.300000 s): " +
          blocked);
  EXPECT_EQ(describe_blocking(kSt, {held("a", et_ms(1250)), held("b", et_ms(1300))}), "");
}

TEST(DescribeState, IsComputingOrWaiting) {
  EXPECT_EQ(describe_state(computing("a", Duration(0), et_ms(1250))),
            "it was computing; last message at ET 1.250000 s");
  EXPECT_EQ(describe_state(held("a", et_ms(1250))),
            "it was waiting for its reply at ET 1.250000 s");
}

struct LifeCase {
  const char* what;
  link::Message message;
  computer::ClockKind clock;
  std::size_t open_calls;
  bool shows_life;
};

TEST(ShowsLife, IgnoresTheHelperThreadOfAStuckSut) {
  const Sampler sensors({}, StepGrid(milliseconds(1)));
  constexpr auto kCpu = computer::ClockKind::kCpu, kWall = computer::ClockKind::kWall;
  const link::Progress same{et_ms(5)}, further{et_ms(6)};
  const LifeCase cases[] = {
      {"a request", link::Request{}, kWall, 0, true},
      {"an annotation", link::Annotation{}, kCpu, 0, false},
      {"CPU time that advanced", further, kCpu, 0, true},
      {"CPU time that did not advance", same, kCpu, 0, false},
      {"the wall clock while no call is open", further, kWall, 0, false},
      {"the wall clock while a call is open", further, kWall, 1, true},
      {"more of a reply in transit", link::Progress{.received_bytes = 8}, kWall, 0, true},
      {"no more of a reply in transit", link::Progress{.received_bytes = 7}, kWall, 0, false},
  };
  for (const LifeCase& c : cases) {
    Standing sut{.running = true,
                 .bound = same.reached,
                 .open_calls = c.open_calls,
                 .received_bytes = 7,
                 .st = {},
                 .sensors = sensors};
    EXPECT_EQ(shows_life(c.message, sut, c.clock), c.shows_life) << c.what;
    sut.bound.reset();
    EXPECT_TRUE(shows_life(c.message, sut, c.clock)) << "in free running: " << c.what;
  }
}

}  // namespace
}  // namespace tether::coordinator
