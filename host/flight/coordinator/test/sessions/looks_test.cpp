#include "coordinator_fixture.h"

#include <chrono>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// Looks at the threads of a SUT while it computes. Each reading of the clock takes 0.1 ms here.
namespace tether::coordinator {
namespace {

using namespace std::chrono_literals;

class Looks : public CoordinatorTest {
 protected:
  Looks() {
    tick_ = 100us;
    options_.hang_limit = 10s;
    hooks_.threads_of = [this](std::size_t) {
      ++looked_;
      if (at_look_) at_look_();
      return std::optional(states_);
    };
    // A SUT that never calls: it computes from the start on until the run is ended.
    hooks_.should_stop = [this]() -> std::optional<Ending> {
      if (now_ < WallTime{} + length_) return std::nullopt;
      return Ending{RunEnd::kInterrupted, "the test ends"};
    };
  }
  SutLooks of_silent_sut(computer::ClockKind clock = computer::ClockKind::kScripted,
                         bool concurrent = false, double factor = 1.0) {
    make();
    link::Hello h = hello("", clock);
    h.clock.factor = factor;
    h.concurrent = concurrent;
    server_->add_sut(h, {});
    now_ = {};
    looked_ = 0;
    return run().suts.at(0).looks;
  }

  Duration length_ = 2s;
  ThreadStates states_;
  int looked_ = 0;
  std::function<void()> at_look_;
};

TEST_F(Looks, AddUpToTheTimeThatASutWaits) {
  SutLooks looks = of_silent_sut();
  EXPECT_NEAR(to_seconds(looks.waiting), 2.0, 0.05);
  EXPECT_EQ(looks.computing, 0s);
  states_ = {.runnable = 2, .is_halted = false};
  looks = of_silent_sut(computer::ClockKind::kCpu);
  EXPECT_EQ(looks.waiting, 0s);
  EXPECT_NEAR(to_seconds(looks.computing), 2.0, 0.05);
  EXPECT_EQ(looks.of_all_threads, 2 * looks.computing);
}

// On a busy machine, the client library's thread waits for a core while it holds a lock.
TEST_F(Looks, DoNotCountWaitingForTheClientLibrary) {
  states_ = {.is_served = true};
  EXPECT_EQ(of_silent_sut().waiting, 0s);
  states_ = {.is_on_disk = true, .is_served = true};
  EXPECT_EQ(of_silent_sut().on_disk, 0s);
  at_look_ = [this] { states_ = {.runnable = looked_ % 2, .is_served = true}; };
  EXPECT_EQ(of_silent_sut().waiting, 0s) << "it computes before and afterwards";
  at_look_ = [this] { states_ = {.is_served = looked_ % 2 == 0}; };
  EXPECT_NEAR(to_seconds(of_silent_sut().waiting), 2.0, 0.1) << "it waits before and afterwards";
}

// It sends progress, because it computes a little between its sleeps.
TEST_F(Looks, EndARunWhoseSutWaitsLongerThanTheHangLimit) {
  options_.hang_limit = 1s;
  make();
  const link::PeerId peer = add_silent();
  ExecTime reached{};
  at_look_ = [&] { server_->deliver(peer, link::Progress{.reached = reached += 1us}); };
  const RunReport report = run();
  EXPECT_EQ(report.end, RunEnd::kSutHung);
  EXPECT_THAT(report.reason,
              testing::HasSubstr("after its last call it waited 1 s (hang_limit_s) on something "
                                 "that Tether does not see"));
  EXPECT_NEAR(to_seconds(report.wall), 1.0, 0.05);
}

// What happened in the second in which the coordinator did not look is not known.
TEST_F(Looks, CountOncePerLookHoweverLateItIs) {
  at_look_ = [this] { now_ += 1s; };
  length_ = 10s;
  EXPECT_LT(of_silent_sut().waiting, 1s);
}

TEST_F(Looks, IgnoreASutThatIsHalted) {
  states_ = {.runnable = 0, .is_halted = true};
  EXPECT_EQ(of_silent_sut().waiting, 0s);
}

TEST_F(Looks, TellWaitingForTheDiskFromOther) {
  states_ = {.runnable = 0, .is_on_disk = true};
  const SutLooks looks = of_silent_sut();
  EXPECT_EQ(looks.waiting, 0s);
  EXPECT_NEAR(to_seconds(looks.on_disk), 2.0, 0.05);
}

// A factor makes more of it than it is.
TEST_F(Looks, FindWaitingThatAFactorOfTheWallClockStretches) {
  EXPECT_GT(of_silent_sut(computer::ClockKind::kWall, false, 6.0).waiting, 0s);
}

TEST_F(Looks, IgnoreSutsWhoseTimePassesWhileTheyWait) {
  for (const auto clock : {computer::ClockKind::kWall, computer::ClockKind::kUnstamped}) {
    EXPECT_EQ(of_silent_sut(clock).waiting, 0s);
    EXPECT_EQ(looked_, 0);
  }
  of_silent_sut(computer::ClockKind::kWall, true, 6.0);
  EXPECT_EQ(looked_, 0);
  set_free_running(1.0);
  of_silent_sut();
  EXPECT_EQ(looked_, 0);
}

// Its request was under way: it waited for the reply.
TEST_F(Looks, DropALookIfARequestHasArrivedSince) {
  make();
  const link::PeerId peer = add_silent();
  std::uint64_t calls = 0;
  at_look_ = [&] {
    ++calls;
    server_->deliver(peer, request(calls, ExecTime(Duration(calls)), link::SetVelocity{}));
  };
  const SutLooks looks = run().suts.at(0).looks;
  EXPECT_GT(calls, 100u);
  EXPECT_EQ(looks.waiting, 0s);
}

// A picture takes 30 ms: looks that were due meanwhile say nothing about what follows.
TEST_F(Looks, DropALookThatWasDueBeforeTheSutComputed) {
  make();
  const link::PeerId peer = add_silent();
  std::uint64_t calls = 0;
  hooks_.on_status = [&](const RunStatus& status) {
    if (status.joined == 0 || calls == 10) return;
    ++calls;
    server_->deliver(peer, request(calls, ExecTime(Duration(calls)), link::SetVelocity{}));
    now_ += 30ms;
  };
  length_ = 1s;
  const SutLooks looks = run().suts.at(0).looks;
  EXPECT_EQ(calls, 10u);
  EXPECT_NEAR(to_seconds(looks.waiting), 1.0 - 10 * 0.03, 0.05);
}

TEST_F(Looks, AreFewerIfTheyTakeLong) {
  at_look_ = [this] { now_ += 1ms; };
  EXPECT_NEAR(to_seconds(of_silent_sut().waiting), 2.0, 0.1);
  EXPECT_LT(looked_, 60);
}

}  // namespace
}  // namespace tether::coordinator
