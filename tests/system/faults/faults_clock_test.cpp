#include "support/faults.h"

#include <cstdlib>
#include <ctime>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// Clocks that are set while a run goes on, and SUTs whose clocks are wrong (docs/guide/faults.md).
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;
using testing::MatchesRegex;

/// Runs under a scripted clock on whose wall clock a day is added once `step_` exists.
class SteppedClock : public testing::Test {
 protected:
  std::unique_ptr<Process> start(const std::string& out) {
    const char* options = std::getenv("ASAN_OPTIONS");
    return std::make_unique<Process>(with(
        tether({"run", scenario_, "--out", folder_ / out}), {},
        {{"LD_PRELOAD", STEPPED_CLOCK_LIBRARY},
         {"STEPPED_CLOCK", step_},
         {"ASAN_OPTIONS", std::string(options ? options : "") + ":verify_asan_link_order=0"}}));
  }

  TempFolder folder_;
  const std::filesystem::path step_ = folder_ / "step";
  const std::filesystem::path scenario_ =
      write_hover_scenario(folder_.path(), "pause", {kScripted});
};

/// The date, in the form of `started_at`.
std::string date(std::time_t at) {
  char text[16] = "";
  std::strftime(text, sizeof text, "%Y-%m-%d", std::gmtime(&at));
  return text;
}

TEST_F(SteppedClock, ByADayInMidRunChangesNothing) {
  constexpr int kNoAnswer = 3;  // its pause is waiting that Tether does not see
  const auto alone = start("alone");
  EXPECT_EQ(alone->wait(60s).code, kNoAnswer) << alone->err();
  EXPECT_EQ(read_result(folder_ / "alone")["outcome"], "goal_reached");

  const auto stepped = start("stepped");
  ASSERT_TRUE(sut_prints(folder_ / "stepped", "pausing")) << stepped->err();
  write_text(step_, "");
  EXPECT_EQ(stepped->wait(60s).code, kNoAnswer) << stepped->err();
  expect_same_runs(folder_ / "stepped", folder_ / "alone");
  const auto this_run = read_result(folder_ / "stepped")["this_run"];
  EXPECT_LT(this_run["wall_s"].get<double>(), 60.0);
  EXPECT_FALSE(this_run.contains("notes")) << this_run;

  // All that is read of it is when the run began.
  const std::time_t before = std::time(nullptr);
  const auto later = start("later");
  EXPECT_EQ(later->wait(60s).code, kNoAnswer) << later->err();
  const std::string began = read_result(folder_ / "later")["this_run"]["started_at"];
  EXPECT_THAT(began.substr(0, 10),
              testing::AnyOf(date(before + 86'400), date(std::time(nullptr) + 86'400)));
}

// ---- A SUT's own clock: host/flight/coordinator/test/clock_plausibility_test.cpp has each case

class WrongClock : public RunTest {};

// Its own TETHER_CLOCK is not that of the run.
TEST_F(WrongClock, OfAnotherKindFactorOrStepIsRefused) {
  const std::tuple<std::string, std::string, std::vector<Substitution>> cases[] = {
      {"scripted*0.001", "slow", {}}, {"cpu", "slow", {}}, {"scripted*0.001", "host", {kScripted}}};
  for (const auto& [clock, condition, changes] : cases) {
    std::vector<Substitution> all = changes;
    all.emplace_back("command = [\"",
                     "command = [\"/usr/bin/env\", \"TETHER_CLOCK=" + clock + "\", \"");
    const Output output = run(flight("good", {"--condition", condition}, all));
    expect_failed(output, {"setup_failed", {"TETHER_CLOCK='"}});
    std::filesystem::remove_all(out_);
  }
}

TEST_F(WrongClock, AheadEndsTheRunWithItsSize) {
  for (const std::string mode : {"lie_later", "lie_in_progress"}) {
    const Output output = run(flight(mode, {"--real-time-factor", "1"},
                                     {kWall, {"hang_limit_s = 2", "hang_limit_s = 30"}}));
    // The stamp, and how far it is ahead.
    EXPECT_THAT(expect_failed(output, {"sut_lost", {}})["reason"].get<std::string>(),
                MatchesRegex(".*\"uav1\".* ET 360.* s.* 3[56][0-9]*\\.[0-9]* s.*"));
    // The simulation has not followed it.
    EXPECT_LT(result()["sync"]["st_at_end_s"].get<double>(), 5.0);
  }
}

TEST_F(WrongClock, ThatGoesBackSpoilsTheResultWithItsSize) {
  const auto result = expect_failed(run(flight("lie_back")), {"finished", {}});
  EXPECT_THAT(result["reason"].get<std::string>(),
              MatchesRegex(".*uav1 #401.* (99|100)[0-9]* ns.*"));
  EXPECT_GE(result["sync"]["causality_violations"].get<int>(), 1);
  EXPECT_EQ(audit_code(out_), 1);
}

}  // namespace
}  // namespace tether::system_test
