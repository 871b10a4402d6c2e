#include "support/faults.h"
#include "support/gazebo.h"

#include <csignal>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// An external simulator is missing, fails, is killed or stopped, at each phase
/// (docs/guide/faults.md). A stand-in takes the place of gzserver; its X server is real. What
/// Gazebo's output means: host/external/sim/gazebo/test.
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::Not;

class StandInGazebo : public RunTest {
 protected:
  Command command(const std::string& mode, const std::string& sut_mode = "good",
                  const Variables& more = {}) {
    const auto scenario = write_hover_scenario(folder_.path(), sut_mode);
    return with(gazebo_run(scenario, out_, stand_in_gazebo(folder_.path(), mode), mark_), {}, more);
  }
  /// With the traces of a simulator that was started, or not.
  std::string expect_lost(const Output& output, const Failure& failure) {
    const auto result = expect_failed(output, failure);
    const bool flew = failure.end == "simulator_lost";
    EXPECT_EQ(std::filesystem::exists(out_ / "record.mcap"), flew);
    if (flew) {
      EXPECT_EQ(result["versions"]["simulator"], "a stand-in, grey");
      EXPECT_EQ(read_record(out_).footer->end, "simulator_lost");
      EXPECT_EQ(audit_code(out_), 0);
      EXPECT_FALSE(std::filesystem::exists(private_folder(out_)));
    }
    return result["reason"];
  }
};

// ---- What is not there

TEST_F(StandInGazebo, WhatItLacksIsNamed) {
  const std::pair<std::string, Variables> lacking[] = {
      {"scripts/gazebo-root",
       {{"TETHER_GAZEBO_ROOT", folder_ / "nothing"}, {"TETHER_GAZEBO_PLUGIN", ""}}},
      {"/nowhere/it.so", {{"TETHER_GAZEBO_PLUGIN", "/nowhere/it.so"}}},
      {"Xvfb", {{"PATH", "/nowhere"}}},
      {"GAZEBO_MASTER_URI", {{"GAZEBO_MASTER_URI", "foo"}}}};
  for (const auto& [named, variables] : lacking) {
    expect_lost(run(command("", "good", variables)), {"setup_failed", {named}});
    std::filesystem::remove_all(folder_ / "root");
  }
}

TEST_F(StandInGazebo, AWorldThatItReadsOtherwiseIsABadFile) {
  const auto world = folder_ / "actor.sdf";
  write_text(world, substituted(read_text(hover_world()),
                                {{"</world>", "<actor name=\"walker\"/></world>"}}));
  const auto scenario = write_hover_scenario(folder_.path(), "good", {{hover_world(), world}});
  const Output output = run(gazebo_run(scenario, out_, stand_in_gazebo(folder_.path(), ""), mark_));
  EXPECT_EQ(output.code, 2);
  EXPECT_THAT(output.err, HasSubstr(world.string() + ":"));
  EXPECT_FALSE(std::filesystem::exists(out_));
}

// ---- What fails by itself, or is struck

struct Fault {
  std::string mode;  ///< of stand_in_simulator.cpp
  Failure failure;   ///< each part of the reason is there once
};

void PrintTo(const Fault& fault, std::ostream* out) {
  *out << fault.mode;
}

class FailingGazebo : public StandInGazebo, public testing::WithParamInterface<Fault> {};

TEST_P(FailingGazebo, EndsTheRunWithItsReason) {
  const auto& [mode, failure] = GetParam();
  const Output output = run(command(mode, "look", {{"TETHER_GAZEBO_START_LIMIT_S", "3"}}));
  const std::string reason = expect_lost(output, failure);
  for (const std::string& part : failure.reason)
    EXPECT_EQ(reason.find(part), reason.rfind(part)) << reason;
  // Output from before the flight is in the log only.
  EXPECT_THAT(reason, Not(HasSubstr("an old line")));
}

const Fault kFaults[] = {
    {"exit_at_start", {"setup_failed", {"code 7", "no wheels", "simulator.log"}}},
    {"silent", {"setup_failed", {"TETHER_GAZEBO_START_LIMIT_S"}}},
    {"misread", {"setup_failed", {"hover.sdf: Unable to find uri[model://wheels]"}}},
    {"no_plugin", {"setup_failed", {"libwheels.so"}}},
    {"no_gl", {"setup_failed", {"rendering is off"}}},
    {"port_in_use", {"setup_failed", {"http://127.0.0.1:"}}},
    {"kill_opening", {"setup_failed", {"signal 9"}}},
    {"stop_opening", {"setup_failed", {}}},
    {"kill_warming_up", {"setup_failed", {"signal 9"}}},
    // hang_limit_s of the scenario.
    {"stop_warming_up", {"setup_failed", {"2 s"}}},
    {"exit_in_flight", {"simulator_lost", {"code 5", "I have had enough"}}},
    {"crash_in_flight", {"simulator_lost", {"signal 11", "wheels came off"}}},
    {"refuse_in_flight", {"simulator_lost", {"the world has come to its end"}}},
    {"old_words", {"simulator_lost", {"signal 6"}}},
    {"stop_advancing", {"simulator_lost", {"2 s"}}},
    {"kill_rendering", {"simulator_lost", {"signal 9"}}},
    {"stop_rendering", {"simulator_lost", {"2 s"}}},
};

INSTANTIATE_TEST_SUITE_P(Modes, FailingGazebo, testing::ValuesIn(kFaults),
                         [](const auto& fault) { return fault.param.mode; });

TEST_F(StandInGazebo, ALostXServerEndsTheRun) {
  EndlessFlight flight(folder_.path(), stand_in_gazebo(folder_.path(), ""), mark_);
  const auto x_server = find_process(mark_, "Xvfb");
  ASSERT_TRUE(x_server);
  kill(*x_server, SIGKILL);
  expect_lost(flight.process().wait(30s), {"simulator_lost", {"signal 9"}});
}

// ---- When the flight is over

class WhenItCloses : public StandInGazebo, public testing::WithParamInterface<std::string> {};

TEST_P(WhenItCloses, ItSpoilsNothingAndLeavesNothing) {
  const Output output = run(command(GetParam()));
  EXPECT_EQ(output.code, 0) << output.err;
  EXPECT_EQ(output.err, "");
  EXPECT_TRUE(wait_until_gone(mark_));
  EXPECT_EQ(result()["outcome"], "goal_reached");
  EXPECT_FALSE(std::filesystem::exists(private_folder(out_)));
}

INSTANTIATE_TEST_SUITE_P(Modes, WhenItCloses,
                         testing::Values("good", "stubborn", "child", "kill_closing",
                                         "stop_closing"),
                         [](const auto& mode) { return mode.param; });

// ---- Stopped for a while

TEST_F(StandInGazebo, ThatIsStoppedForAWhileIsReportedAndWaitedFor) {
  Command patient = gazebo_run(
      write_hover_scenario(folder_.path(), "good", {{"hang_limit_s = 2", "hang_limit_s = 60"}}),
      out_, stand_in_gazebo(folder_.path(), "stop_advancing"), mark_);
  std::erase(patient.arguments, "--quiet");
  Process process(patient);
  ASSERT_TRUE(process.wait_for_err("a stand-in", 60s)) << process.err();
  // The stand-in strikes at each step from there on.
  while (!process.has_ended()) {
    if (const auto simulator = find_process(mark_, "gzserver")) kill(*simulator, SIGCONT);
    wait_until([&] { return process.has_ended(); }, 5ms);
  }
  EXPECT_EQ(process.wait(5s).code, 0) << process.err();
  EXPECT_EQ(result()["outcome"], "goal_reached");
}

// ---- What the user ends

TEST_F(StandInGazebo, CtrlCEndsTheRunWithAllItsProcesses) {
  EndlessFlight flight(folder_.path(), stand_in_gazebo(folder_.path(), ""), mark_);
  const auto x_server = find_process(mark_, "Xvfb");
  ASSERT_TRUE(x_server);
  flight.process().signal(SIGINT);
  expect_failed(flight.process().wait(10s), {"interrupted", {}});
  EXPECT_EQ(read_record(out_).footer->end, "interrupted");
  EXPECT_FALSE(has_x_lock(*x_server));
  EXPECT_FALSE(std::filesystem::exists(private_folder(out_)));
}

// While it starts, and while it is stopped in flight.
TEST_F(StandInGazebo, CtrlCDoesNotWaitForOneThatHangs) {
  for (const std::string mode : {"silent", "stop_in_flight"}) {
    Process process(command(mode, "fly_on"));
    EXPECT_TRUE(wait_until([&] {
      const auto gazebo = find_process(mark_, "gzserver");
      if (!gazebo || mode == "silent") return gazebo.has_value();
      const std::string status = read_text("/proc/" + std::to_string(*gazebo) + "/status");
      return status.find("T (stopped)") != std::string::npos;
    }));
    process.signal(SIGINT);
    expect_failed(process.wait(10s), {"interrupted", {}});
    std::filesystem::remove_all(folder_ / "root");
  }
}

TEST_F(StandInGazebo, ATetherThatIsKilledTakesAllWithItAndTheNextRunItsFolder) {
  const Variables stand_in = stand_in_gazebo(folder_.path(), "");
  EndlessFlight flight(folder_.path(), stand_in, mark_);
  const auto left = private_folder(out_);
  const auto x_server = find_process(mark_, "Xvfb");
  ASSERT_TRUE(x_server);
  flight.process().signal(SIGKILL);
  EXPECT_TRUE(wait_until_gone(mark_));
  EXPECT_FALSE(has_x_lock(*x_server));
  EXPECT_FALSE(std::filesystem::exists(out_ / "result.json"));
  EXPECT_TRUE(std::filesystem::exists(left));
  const auto scenario = write_hover_scenario(folder_.path(), "good");
  EXPECT_EQ(run(gazebo_run(scenario, folder_ / "next", stand_in, mark_)).code, 0);
  EXPECT_FALSE(std::filesystem::exists(left));
}

}  // namespace
}  // namespace tether::system_test
