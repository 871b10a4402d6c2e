#include "support/faults.h"

#include <cstdlib>
#include <ctime>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// Clocks that are set while a run goes on, and SUTs whose clocks lie (docs/guide/faults.md).
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::MatchesRegex;

// ---- The machine's wall clock

class SteppedClock : public testing::Test {
 protected:
  /// A run under a scripted clock on whose wall clock a day is added once `step_` exists.
  std::unique_ptr<Process> start(const std::string& out) {
    const auto scenario = write_hover_scenario(
        folder_.path(), "pause", {{"clock = \"cpu\"", "clock = \"scripted\"\ncomputing_ms = 2"}});
    Command command = tether({"run", scenario, "--out", folder_ / out});
    const char* options = std::getenv("ASAN_OPTIONS");
    command.environment.insert(
        command.environment.end(),
        {{"LD_PRELOAD", STEPPED_CLOCK_LIBRARY},
         {"STEPPED_CLOCK", step_},
         {"ASAN_OPTIONS", std::string(options ? options : "") + ":verify_asan_link_order=0"}});
    return std::make_unique<Process>(command);
  }
  std::string started_at(const std::string& out) const {
    return read_result(folder_ / out)["this_run"]["started_at"];
  }

  TempFolder folder_;
  const std::filesystem::path step_ = folder_ / "step";
};

/// The date, in the form of `started_at`.
std::string date(std::time_t at) {
  char text[16] = "";
  std::strftime(text, sizeof text, "%Y-%m-%d", std::gmtime(&at));
  return text;
}

TEST_F(SteppedClock, ByADayInMidRunChangesNothing) {
  const auto alone = start("alone");
  EXPECT_EQ(alone->wait(60s).code, 0) << alone->err();

  const auto stepped = start("stepped");
  ASSERT_TRUE(wait_until([&] {
    return read_text(folder_ / "stepped/sut-uav1.log").find("pausing") != std::string::npos;
  })) << stepped->err();
  write_text(step_, "");
  EXPECT_EQ(stepped->wait(60s).code, 0) << stepped->err();
  EXPECT_EQ(timeless_result(folder_ / "stepped"), timeless_result(folder_ / "alone"));
  EXPECT_EQ(timeless_record(folder_ / "stepped"), timeless_record(folder_ / "alone"));
  const auto this_run = read_result(folder_ / "stepped")["this_run"];
  EXPECT_LT(this_run["wall_s"].get<double>(), 60.0);
  EXPECT_FALSE(this_run.contains("notes")) << this_run;

  // What is read of it at all is when the run began.
  const std::time_t before = std::time(nullptr);
  const auto later = start("later");
  EXPECT_EQ(later->wait(60s).code, 0) << later->err();
  const std::time_t after = std::time(nullptr);
  EXPECT_THAT(started_at("later").substr(0, 10),
              testing::AnyOf(date(before + 86'400), date(after + 86'400)));
  EXPECT_EQ(timeless_result(folder_ / "later"), timeless_result(folder_ / "alone"));
}

// ---- A SUT's own clock

struct Lie {
  std::string mode;  ///< of bad_sut.cpp
  std::string end;
};

void PrintTo(const Lie& lie, std::ostream* out) {
  *out << lie.mode;
}

class ClockAhead : public testing::TestWithParam<Lie> {};

TEST_P(ClockAhead, EndsTheRunWithItsSize) {
  const TempFolder folder;
  const std::string mark = mark_of_test();
  const auto scenario = write_hover_scenario(
      folder.path(), GetParam().mode,
      {{"clock = \"cpu\"", "clock = \"wall\""}, {"hang_limit_s = 2", "hang_limit_s = 30"}});
  const Output output =
      run(tether({"run", scenario, "--out", folder / "out", "--real-time-factor", "1"}, mark));
  const auto result = expect_failed(output, folder / "out", {GetParam().end, {}}, mark);
  // The stamp, and how far it is ahead.
  EXPECT_THAT(result["reason"].get<std::string>(),
              MatchesRegex(".*\"uav1\".* ET 360.* s.* 3[56][0-9]*\\.[0-9]* s.*"));
  // The simulation has not followed it.
  EXPECT_LT(result["sync"]["st_at_end_s"].get<double>(), 5.0);
}

const Lie kLies[] = {
    {"lie_first", "setup_failed"}, {"lie_later", "sut_lost"}, {"lie_in_progress", "sut_lost"}};

INSTANTIATE_TEST_SUITE_P(Lies, ClockAhead, testing::ValuesIn(kLies),
                         [](const auto& lie) { return lie.param.mode; });

TEST(ClockThatGoesBack, SpoilsTheResultWithItsSize) {
  const TempFolder folder;
  const std::string mark = mark_of_test();
  const Output output = run(tether(
      {"run", write_hover_scenario(folder.path(), "lie_back"), "--out", folder / "out"}, mark));
  const auto result = expect_failed(output, folder / "out", {"finished", {}}, mark);
  EXPECT_THAT(result["reason"].get<std::string>(),
              MatchesRegex(".*uav1 #401.* (99|100)[0-9]* ns.*"));
  EXPECT_GE(result["sync"]["causality_violations"].get<int>(), 1);
  EXPECT_EQ(run(tether({"audit", folder / "out/record.mcap"})).code, 1);
}

}  // namespace
}  // namespace tether::system_test
