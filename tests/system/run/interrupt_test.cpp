#include "support/trials.h"

#include <csignal>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// A run that is stopped from outside.
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;

/// How many interactions are in the record so far. What was written last is still on its way.
std::size_t recorded_so_far(const std::filesystem::path& folder) {
  try {
    return read_record(folder).interactions.size();
  } catch (const std::exception&) {
    return 0;
  }
}

/// A run at real time whose SUT flies 400 interactions in 1.5 s, and then as its mode says; the
/// time limit is far.
class InMidRun : public testing::Test {
 protected:
  void start(const std::string& mode, std::size_t interactions) {
    const auto scenario =
        write_hover_scenario(folder_.path(), mode, {{"time_limit_s = 5", "time_limit_s = 600"}});
    tether_ = std::make_unique<Process>(
        tether({"run", scenario, "--real-time-factor", "1", "--out", folder_ / "out"}, mark_));
    const auto deadline = std::chrono::steady_clock::now() + 60s;
    while (recorded_so_far(folder_ / "out") < interactions) {
      ASSERT_LT(std::chrono::steady_clock::now(), deadline);
      ASSERT_FALSE(tether_->has_ended()) << tether_->err();
      std::this_thread::sleep_for(50ms);
    }
    ASSERT_EQ(processes_with_mark(mark_).size(), 2u);
  }

  const std::string mark_ =
      std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) +
      std::to_string(getpid());
  TempFolder folder_;
  std::unique_ptr<Process> tether_;
};

TEST_F(InMidRun, CtrlCEndsItCleanly) {
  start("fly_on", 100);
  tether_->signal(SIGINT);
  const Output output = tether_->wait(10s);
  EXPECT_EQ(output.code, 3);
  const auto result = read_result(folder_ / "out");
  EXPECT_EQ(result["end"], "interrupted");
  EXPECT_EQ(result["outcome"], "failed");
  const record::Record record = read_record(folder_ / "out");
  EXPECT_EQ(record.damage, "");
  EXPECT_EQ(record.footer->end, "interrupted");
  EXPECT_GT(record.footer->st_at_end, from_ns<SimTime>(300'000'000));  // of 100 interactions
  EXPECT_EQ(run(tether({"audit", folder_ / "out/record.mcap"})).code, 0);
  EXPECT_TRUE(wait_until_gone(mark_));
}

TEST_F(InMidRun, TerminationEndsItToo) {
  start("fly_on", 100);
  tether_->signal(SIGTERM);
  EXPECT_EQ(tether_->wait(10s).code, 3);
  EXPECT_EQ(read_result(folder_ / "out")["end"], "interrupted");
  EXPECT_TRUE(wait_until_gone(mark_));
}

TEST_F(InMidRun, CtrlCDoesNotWaitForAStubbornSut) {
  start("stubborn", 400);
  tether_->signal(SIGINT);
  EXPECT_EQ(tether_->wait(10s).code, 3);
  EXPECT_TRUE(wait_until_gone(mark_));
}

TEST_F(InMidRun, BeingKilledLeavesAReadableRecordAndNoSut) {
  start("fly_on", 100);
  tether_->signal(SIGKILL);
  EXPECT_EQ(tether_->wait(10s).code, 128 + SIGKILL);
  EXPECT_TRUE(wait_until_gone(mark_));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out/result.json"));

  const record::Record record = read_record(folder_ / "out");
  EXPECT_EQ(record.header.scenario, "hover");
  EXPECT_GE(record.interactions.size(), 100u);
  EXPECT_FALSE(record.footer);
  const Output audit = run(tether({"audit", folder_ / "out/record.mcap"}));
  EXPECT_EQ(audit.code, 1);
}

TEST(BeforeTheSutHasJoined, CtrlCEndsTheRun) {
  const TempFolder folder;
  ExternalRun run(write_hover_scenario(folder.path(), "good"), folder / "out");
  run.process().signal(SIGINT);
  EXPECT_EQ(run.wait(10s).code, 3);
  EXPECT_EQ(read_result(folder / "out")["end"], "interrupted");
}

}  // namespace
}  // namespace tether::system_test
