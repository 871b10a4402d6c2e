#include "suts/sut_watch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::runner {
namespace {

using campaign::Doubt;
using computer::ClockKind;
using coordinator::SutLooks;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::ElementsAre;
using testing::IsEmpty;

coordinator::SutReport report(Duration et, SutLooks looks) {
  return {.uav = "uav1", .sut = {}, .finish = {}, .et = ExecTime(et), .looks = looks};
}

TEST(SutWatch, DoubtsWaitingOfMoreThanAHundredthOfTheFlight) {
  for (const ClockKind kind : {ClockKind::kCpu, ClockKind::kScripted, ClockKind::kCounted}) {
    const computer::Clock clock{kind};
    EXPECT_THAT(doubts_of(report(seconds(20), {.waiting = milliseconds(20)}), clock), IsEmpty());
    EXPECT_THAT(doubts_of(report(seconds(20), {.waiting = milliseconds(200)}), clock),
                ElementsAre(Doubt{Doubt::Kind::kSlightWait, "uav1", 0.01}));
    EXPECT_THAT(doubts_of(report(seconds(20), {.waiting = milliseconds(202)}), clock),
                ElementsAre(Doubt{Doubt::Kind::kUnseenWait, "uav1", 0.202}));
    EXPECT_THAT(doubts_of(report(milliseconds(19), {.waiting = milliseconds(100)}), clock),
                ElementsAre(Doubt{Doubt::Kind::kSlightWait, "uav1", 1.0}));
    EXPECT_THAT(doubts_of(report(milliseconds(19), {.waiting = seconds(5)}), clock),
                ElementsAre(Doubt{Doubt::Kind::kUnseenWait, "uav1", 5.0}));
  }
}

// For a helper that computes 0.9 ms for each of 90 images, 200 times slower.
TEST(SutWatch, DoubtsWaitingThatTheModelledComputerMakesLong) {
  const computer::Clock slow{ClockKind::kCpu, 200.0}, board{ClockKind::kCpu, 6.0};
  EXPECT_THAT(doubts_of(report(seconds(20), {.waiting = milliseconds(81)}), slow),
              ElementsAre(Doubt{Doubt::Kind::kUnseenWait, "uav1", 16.2}));
  EXPECT_THAT(doubts_of(report(seconds(20), {.waiting = milliseconds(10)}), slow),
              ElementsAre(Doubt{Doubt::Kind::kSlightWait, "uav1", 0.1}));
  EXPECT_THAT(doubts_of(report(seconds(6), {.waiting = milliseconds(40)}), board),
              ElementsAre(Doubt{Doubt::Kind::kSlightWait, "uav1", 0.04}))
      << "as seen on a busy machine";
}

// With two threads of Python, at each of 7000 messages.
TEST(SutWatch, OfAProgramAsItIsNoFactorStretchesWhatItWaits) {
  const computer::Clock slow{ClockKind::kCpu, 12.0};
  EXPECT_THAT(doubts_of(report(seconds(20), {.waiting = milliseconds(700)}), slow, false, true),
              IsEmpty());
  EXPECT_THAT(doubts_of(report(seconds(20), {.waiting = seconds(3)}), slow, false, true),
              ElementsAre(Doubt{Doubt::Kind::kUnseenWait, "uav1", 3.0}));
}

TEST(SutWatch, DoubtsNoWaitingThatAReplayedWallTimeHas) {
  const auto sut = report(seconds(9), {.waiting = seconds(5)});
  EXPECT_THAT(doubts_of(sut, {ClockKind::kReplayed}, true), IsEmpty());
  EXPECT_EQ(doubts_of(sut, {ClockKind::kReplayed}, false).size(), 1u);
}

// Of 40 ms at two threads, the CPU clock makes 80 ms × 6.
TEST(SutWatch, DoubtsThreadsWhoseTimesACpuClockAddsUp) {
  SutLooks looks{
      .computing = milliseconds(40), .of_all_threads = milliseconds(80), .parallel_looks = 5};
  const auto sut = report(milliseconds(468), looks);
  EXPECT_THAT(doubts_of(sut, {ClockKind::kCpu, 6.0}),
              ElementsAre(Doubt{Doubt::Kind::kParallelThreads, "uav1", 2.0}));
  EXPECT_THAT(doubts_of(sut, {ClockKind::kScripted}), IsEmpty());
  looks.parallel_looks = 4;
  EXPECT_THAT(doubts_of(report(milliseconds(468), looks), {ClockKind::kCpu, 6.0}), IsEmpty())
      << "on a busy machine, each stands for 50 ms";
  const SutLooks hardly{
      .computing = seconds(1), .of_all_threads = milliseconds(1099), .parallel_looks = 99};
  EXPECT_THAT(doubts_of(report(seconds(1), hardly), {ClockKind::kCpu}), IsEmpty());
}

TEST(SutWatch, DoubtsWaitingForTheDiskOfMoreThanATenthOfTheFlight) {
  const computer::Clock cpu{ClockKind::kCpu}, wall{ClockKind::kWall, 6.0};
  EXPECT_THAT(doubts_of(report(seconds(9), {.on_disk = milliseconds(899)}), cpu), IsEmpty());
  EXPECT_THAT(doubts_of(report(seconds(9), {.on_disk = milliseconds(950)}), cpu),
              ElementsAre(Doubt{Doubt::Kind::kDiskWait, "uav1", 0.95}));
  EXPECT_THAT(doubts_of(report(milliseconds(100), {.on_disk = milliseconds(190)}), cpu), IsEmpty());
  EXPECT_THAT(doubts_of(report(seconds(9), {.on_disk = seconds(5)}), wall), IsEmpty());
}

// Of 100 ms, a factor of 6 makes 600 ms.
TEST(SutWatch, DoubtsWaitingThatAFactorOfTheWallClockStretches) {
  const auto sut = report(seconds(9), {.waiting = milliseconds(100)});
  EXPECT_THAT(doubts_of(sut, {ClockKind::kWall, 6.0}),
              ElementsAre(Doubt{Doubt::Kind::kStretchedWait, "uav1", 0.1}));
  EXPECT_THAT(doubts_of(report(seconds(9), {.waiting = milliseconds(16)}), {ClockKind::kWall, 6.0}),
              IsEmpty());
}

}  // namespace
}  // namespace tether::runner
