#include "watchdog.h"

#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::coordinator {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::HasSubstr;
using testing::StartsWith;

WallTime at(Duration t) {
  return WallTime{} + t;
}

/// Two SUTs that are waited for from 0 on; begin() has both of them fly.
class Watching : public testing::Test {
 protected:
  Watchdog make(bool tied = true) {
    return {{SimTime(seconds(60)), seconds(5), seconds(3)}, 2, tied, WallTime{}};
  }
  static Party party(const char* uav, Duration silence, bool computing = true) {
    return {.sut = "sut", .uav = uav, .computing = computing, .bound = {}, .silence = silence};
  }
  static Party absent(const char* uav, Duration waited) {
    Party party = Watching::party(uav, waited, false);
    party.joined = false;
    return party;
  }
  static constexpr SimTime kSt{milliseconds(5)};
};

TEST_F(Watching, ARunEndsAtItsLimitOfSt) {
  const Watchdog watchdog = make();
  EXPECT_FALSE(watchdog.over_time(SimTime(seconds(60) - milliseconds(1))));
  EXPECT_EQ(watchdog.over_time(SimTime(seconds(60)))->how, RunEnd::kTimeLimit);
}

TEST_F(Watching, ASutThatDoesNotJoinInTimeIsLost) {
  const Watchdog watchdog = make();
  const Party joined = party("a", seconds(90));
  EXPECT_FALSE(watchdog.overdue({joined, absent("b", seconds(5))}, kSt));
  const auto end = watchdog.overdue({joined, absent("b", milliseconds(5'001))}, kSt);
  ASSERT_TRUE(end);
  EXPECT_EQ(end->how, RunEnd::kSutLost);
  EXPECT_EQ(end->reason, "no SUT joined for UAV \"b\" within 5 s");
}

TEST_F(Watching, ASutThatComputesWithoutASignOfLifeIsHung) {
  Watchdog watchdog = make();
  watchdog.begin(WallTime{});
  EXPECT_FALSE(watchdog.overdue({party("a", seconds(3)), party("b", seconds(9), false)}, kSt));
  const auto end = watchdog.overdue({party("a", seconds(0)), party("b", seconds(4))}, kSt);
  ASSERT_TRUE(end);
  EXPECT_EQ(end->how, RunEnd::kSutHung);
  EXPECT_THAT(
      end->reason,
      StartsWith("SUT \"sut\" of UAV \"b\" timed out: no message for 3 s (hang_limit_s): ST"));
}

TEST_F(Watching, SilenceIsCountedFromTheLastSignOfLife) {
  Watchdog watchdog = make();
  watchdog.heard(1, at(seconds(2)));
  EXPECT_EQ(watchdog.silence(0, at(seconds(3))), seconds(3));
  EXPECT_EQ(watchdog.silence(1, at(seconds(3))), seconds(1));
  watchdog.begin(at(seconds(3)));
  EXPECT_EQ(watchdog.silence(0, at(seconds(3))), seconds(0));
}

TEST_F(Watching, IsDueEvery20Milliseconds) {
  Watchdog watchdog = make();
  EXPECT_FALSE(watchdog.is_due(at(milliseconds(19))));
  EXPECT_TRUE(watchdog.is_due(at(milliseconds(20))));
  EXPECT_FALSE(watchdog.is_due(at(milliseconds(39))));
}

TEST_F(Watching, TimeWithoutTurnsDoesNotCountAsSilence) {
  Watchdog watchdog = make();
  ASSERT_TRUE(watchdog.is_due(at(milliseconds(500))));
  watchdog.heard(1, at(milliseconds(900)));
  ASSERT_TRUE(
      watchdog.is_due(at(milliseconds(60'500))));  // all but a second of that does not count
  EXPECT_EQ(watchdog.silence(0, at(milliseconds(60'500))), milliseconds(1'500));
  EXPECT_EQ(watchdog.silence(1, at(milliseconds(60'500))), milliseconds(600));
  EXPECT_THAT(watchdog.blocked({absent("a", seconds(1))}, kSt, at(milliseconds(60'500))),
              HasSubstr("\"a\""));
}

TEST_F(Watching, SaysWhoBlocksWhomOnceNothingHasMovedForASecond) {
  Watchdog watchdog = make();
  watchdog.begin(WallTime{});
  watchdog.moved(at(seconds(7)));
  const std::vector<Party> parties{party("a", seconds(1))};
  EXPECT_EQ(watchdog.blocked(parties, kSt, at(milliseconds(7'999))), "");
  EXPECT_THAT(watchdog.blocked(parties, kSt, at(seconds(8))),
              StartsWith("ST 0.005000 s: blocked on SUT \"sut\" (UAV \"a\")"));
  Watchdog free_running = make(false);
  free_running.begin(WallTime{});
  EXPECT_EQ(free_running.blocked(parties, kSt, at(seconds(8))), "");
}

// As it waits for them in free running too.
TEST_F(Watching, SaysWhoseSutHasNotJoinedBeforeTheRun) {
  for (const bool tied : {true, false}) {
    const Watchdog watchdog = make(tied);
    EXPECT_EQ(
        watchdog.blocked({absent("a", seconds(2)), party("b", seconds(9))}, kSt, at(seconds(2))),
        "waiting for the SUT of \"a\" to connect (2.0 s so far)");
  }
}

struct LifeCase {
  const char* what;
  link::Message message;
  link::ClockKind clock;
  std::size_t open_calls;
  bool shows_life;
};

TEST(ShowsLife, IgnoresTheHelperThreadOfAStuckSut) {
  const Sampler sensors({}, StepGrid(milliseconds(1)), true);
  constexpr auto kCpu = link::ClockKind::kCpu, kWall = link::ClockKind::kWall;
  const link::Progress same{ExecTime(milliseconds(5))}, further{ExecTime(milliseconds(6))};
  const LifeCase cases[] = {
      {"a request", link::Request{}, kWall, 0, true},
      {"an annotation", link::Annotation{}, kCpu, 0, false},
      {"CPU time that went on", further, kCpu, 0, true},
      {"CPU time that did not", same, kCpu, 0, false},
      {"the wall clock went on while no call is open", further, kWall, 0, false},
      {"the wall clock went on while a call is open", further, kWall, 1, true},
  };
  for (const LifeCase& c : cases) {
    Standing sut{.running = true,
                 .bound = same.reached,
                 .open_calls = c.open_calls,
                 .st = {},
                 .sensors = sensors};
    EXPECT_EQ(shows_life(c.message, sut, c.clock), c.shows_life) << c.what;
    sut.tied = false;
    EXPECT_TRUE(shows_life(c.message, sut, c.clock)) << "in free running: " << c.what;
  }
}

}  // namespace
}  // namespace tether::coordinator
