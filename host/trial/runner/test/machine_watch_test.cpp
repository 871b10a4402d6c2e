#include "machine_watch.h"

#include <gtest/gtest.h>

namespace tether::runner {
namespace {

using namespace std::chrono_literals;

/// A machine of two processors whose readings the test sets.
class Machine : public testing::Test {
 protected:
  campaign::MachineLoad load(bool knows_programs = true) {
    before_ = true;
    MachineWatch watch({.time_block = [this] { return block(); },
                        .processors = [this] { return std::optional(processors_); },
                        .own = [this] { return own_; }});
    before_ = false;
    is_during_ = true;
    for (Duration now{0}; now < length_; now += 100ms) watch.during_run(WallTime(1h + now));
    is_during_ = false;
    own_ += own_in_run_;
    processors_.used += own_in_run_ + others_in_run_;
    processors_.stolen += stolen_in_run_;
    processors_.idle += 20s - own_in_run_ - others_in_run_ - stolen_in_run_;
    watch.end_of_run();
    own_ += 1s;  // of measuring
    processors_.used += 1s;
    return watch.load(knows_programs);
  }
  Duration block() {
    ++blocks_;
    if (blocks_ % 5 == 0) return 20 * block_before_;  // an interrupt
    if (is_during_) return block_during_;
    return before_ ? block_before_ : block_after_;
  }

  os::ProcessorTime processors_{.used = 100h, .stolen = 1h, .idle = 300h};
  Duration own_ = 3s, own_in_run_ = 12s, others_in_run_{0}, stolen_in_run_{0};
  Duration block_before_ = 1000us, block_after_ = 1000us, block_during_ = 1000us;
  int blocks_ = 0;
  bool before_ = true, is_during_ = false;
  Duration length_{0};
};

TEST_F(Machine, IsIdleAndEvenWhateverTheRunItselfComputes) {
  const auto idle = load();
  EXPECT_EQ(idle, (campaign::MachineLoad{"host", 0.0, 0.0}));
  EXPECT_FALSE(doubt_of(idle, true));
}

TEST_F(Machine, IsBusyIfOthersTakeATenthOfIt) {
  others_in_run_ = 1900ms;
  EXPECT_NEAR(load().others, 0.095, 1e-9);
  EXPECT_FALSE(doubt_of(load(), true));
  stolen_in_run_ = 200ms;
  const auto busy = load();
  EXPECT_NEAR(busy.others, 0.105, 1e-9);
  const auto doubt = doubt_of(busy, true);
  ASSERT_TRUE(doubt);
  EXPECT_EQ(doubt->kind, campaign::Doubt::Kind::kBusyMachine);
  EXPECT_EQ(doubt->subject, "");
  EXPECT_NEAR(doubt->amount, 0.105, 1e-9) << "more than its blocks show";
  EXPECT_FALSE(doubt_of(busy, false)) << "a CPU clock does not count what others take";
  EXPECT_FALSE(doubt_of({"host", 0.0, 0.4}, false));
  EXPECT_NEAR(doubt_of({"host", 0.0, 0.9}, false).value().amount, 0.81, 1e-9)
      << "but slower caches";
  EXPECT_EQ(load(false).others, 0.0);
}

TEST_F(Machine, IsUnevenIfABlockTakesATenthLongerDuringTheRunOrAtOneEndOfAShortOne) {
  block_after_ = 1090us;
  EXPECT_FALSE(doubt_of(load(), true));
  block_before_ = 1300us;
  block_after_ = 1000us;
  const auto uneven = load();
  EXPECT_NEAR(uneven.block_spread, 1300.0 / 1000.0 - 1.0, 1e-9);
  EXPECT_NEAR(doubt_of(uneven, false)->amount, uneven.block_spread, 1e-9);
  block_before_ = 1200us;
  length_ = 2s;
  EXPECT_EQ(load().block_spread, 0.0) << "the run itself was even";
  block_before_ = 1000us;
  block_during_ = 1800us;
  EXPECT_NEAR(load().block_spread, 0.8, 1e-9);
}

TEST(BoardLoad, IsReadFromItsReadings) {
  campaign::TargetReport target{.name = "pi",
                                .address = "ssh://pi",
                                .before = {{"uptime_s", "10"}, {"cpu_wait_us", "0"}},
                                .after = {{"uptime_s", "20"}, {"cpu_wait_us", "1500000"}}};
  EXPECT_EQ(load_of_board(target), (campaign::MachineLoad{"pi", 0.0, 0.15}));
  target.address = "";
  EXPECT_FALSE(load_of_board(target));
}

TEST_F(Machine, IsReadInTheTimeOfTheClock) {
  for (const clockid_t clock : {CLOCK_THREAD_CPUTIME_ID, CLOCK_MONOTONIC}) {
    const MachineReader reader = machine_reader(clock);
    EXPECT_GT(reader.time_block(), 50us);
    EXPECT_TRUE(reader.processors());
    EXPECT_GT(reader.own(), 0s);
  }
}

TEST(TargetReport, MentionsAThrottledBoardInTheReason) {
  record::TargetInfo info{"board", "ssh://pi@board", {{"throttled", "0x0"}}};
  std::string reason = "reached";
  EXPECT_FALSE(report_of(info, {}, reason).is_spoiled);
  EXPECT_EQ(reason, "reached");
  const auto board = report_of(info, {{"throttled", "0x50005"}}, reason);
  EXPECT_TRUE(board.is_spoiled);
  EXPECT_EQ(board.after.at("throttled"), "0x50005");
  EXPECT_EQ(reason, "reached; but " + board.warnings.front());
  info.address.clear();
  reason = "reached";
  EXPECT_EQ(report_of(info, {{"throttled", "0x50005"}}, reason).warnings.size(), 1u);
  EXPECT_EQ(reason, "reached");
}

}  // namespace
}  // namespace tether::runner
