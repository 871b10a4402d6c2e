#include "support/faults.h"
#include "support/gazebo.h"

#include <csignal>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// A simulator outside is killed or stopped, whatever it does just then (docs/guide/faults.md); a
/// stand-in takes the place of gzserver. What else can go wrong with it: simulator_faults_test.cpp.
namespace tether::system_test {
namespace {

struct StruckSimulator {
  std::string mode;  ///< of stand_in_simulator.cpp
  Failure failure;
};

void PrintTo(const StruckSimulator& struck, std::ostream* out) {
  *out << struck.mode;
}

class AtEachPhase : public testing::TestWithParam<StruckSimulator> {};

TEST_P(AtEachPhase, AStruckSimulatorIsNamed) {
  const TempFolder folder;
  const std::string mark = mark_of_test();
  Variables variables = stand_in_gazebo(folder.path(), GetParam().mode);
  variables.emplace_back("TETHER_GAZEBO_START_LIMIT_S", "5");
  const Output output =
      run(gazebo_run(write_hover_scenario(folder.path(), "look"), folder / "out", variables, mark));
  expect_failed(output, folder / "out", GetParam().failure, mark);
  EXPECT_FALSE(std::filesystem::exists(private_folder(folder / "out")));
  const bool began = GetParam().failure.end != "setup_failed";
  EXPECT_EQ(std::filesystem::exists(folder / "out/record.mcap"), began);
  if (!began) return;
  EXPECT_EQ(read_record(folder / "out").footer->end, "simulator_lost");
  EXPECT_EQ(run(tether({"audit", folder / "out/record.mcap"})).code, 0);
}

const std::string kKilled = "signal 9";

const StruckSimulator kStruckSimulators[] = {
    {"kill_opening", {"setup_failed", {kKilled}}},
    {"kill_warming_up", {"setup_failed", {kKilled}}},
    {"kill_advancing", {"simulator_lost", {kKilled}}},
    {"kill_rendering", {"simulator_lost", {kKilled}}},
    {"stop_opening", {"setup_failed", {"gzserver"}}},
    // hang_limit_s of the scenario.
    {"stop_warming_up", {"setup_failed", {"2 s"}}},
    {"stop_advancing", {"simulator_lost", {"2 s"}}},
    {"stop_rendering", {"simulator_lost", {"2 s"}}},
};

INSTANTIATE_TEST_SUITE_P(Phases, AtEachPhase, testing::ValuesIn(kStruckSimulators),
                         [](const auto& struck) { return struck.param.mode; });

// ---- When the flight is over

class WhenItCloses : public testing::TestWithParam<std::string> {};

TEST_P(WhenItCloses, AStruckSimulatorSpoilsNothing) {
  const TempFolder folder;
  const std::string mark = mark_of_test();
  const Output output = run(gazebo_run(write_hover_scenario(folder.path(), "good"), folder / "out",
                                       stand_in_gazebo(folder.path(), GetParam()), mark));
  EXPECT_EQ(output.code, 0) << output.err;
  EXPECT_TRUE(wait_until_gone(mark));
  EXPECT_EQ(read_result(folder / "out")["outcome"], "goal_reached");
  EXPECT_FALSE(std::filesystem::exists(private_folder(folder / "out")));
}

INSTANTIATE_TEST_SUITE_P(Modes, WhenItCloses, testing::Values("kill_closing", "stop_closing"),
                         [](const auto& mode) { return mode.param; });

// ---- Stopped for a while

TEST(StoppedSimulator, IsWaitedForAndSaid) {
  const TempFolder folder;
  const std::string mark = mark_of_test();
  Command command = gazebo_run(
      write_hover_scenario(folder.path(), "good", {{"hang_limit_s = 2", "hang_limit_s = 60"}}),
      folder / "out", stand_in_gazebo(folder.path(), "stop_advancing"), mark);
  std::erase(command.arguments, "--quiet");
  Process process(command);
  ASSERT_TRUE(process.wait_for_err("a stand-in", std::chrono::seconds(60))) << process.err();
  // The stand-in strikes at each step from there on.
  while (!process.has_ended()) {
    if (const auto simulator = find_process(mark, "gzserver")) kill(*simulator, SIGCONT);
    wait_until([&] { return process.has_ended(); }, std::chrono::milliseconds(5));
  }
  EXPECT_EQ(process.wait(std::chrono::seconds(5)).code, 0) << process.err();
  EXPECT_EQ(read_result(folder / "out")["outcome"], "goal_reached");
}

}  // namespace
}  // namespace tether::system_test
