#include "support/gazebo.h"

#include <csignal>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// `--simulator gazebo` when Gazebo fails: a reason, exit code 3, nothing left. A stand-in fails in
/// the place of gzserver where the real one cannot be made to; its X server is real.
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class StandInGazebo : public testing::Test {
 protected:
  Variables stand_in(const std::string& mode, const Variables& more = {}) {
    Variables variables = stand_in_gazebo(folder_.path(), mode);
    variables.insert(variables.end(), more.begin(), more.end());
    return variables;
  }
  std::filesystem::path hover(const std::string& sut_mode = "good") {
    return write_hover_scenario(folder_.path(), sut_mode);
  }
  Command command(const Variables& variables, const std::string& sut_mode = "good") {
    return gazebo_run(hover(sut_mode), folder_ / "out", variables, mark_);
  }
  /// What every failure must show; returns its reason.
  std::string expect_failure(const Output& output, const std::string& end) {
    EXPECT_EQ(output.code, 3);
    const auto result = read_result(folder_ / "out");
    const std::string reason = result["reason"];
    EXPECT_EQ(result["outcome"], "failed");
    EXPECT_EQ(result["end"], end);
    EXPECT_THAT(reason, Not(HasSubstr("\n")));
    EXPECT_THAT(output.err, HasSubstr("tether: " + reason));
    EXPECT_EQ(std::filesystem::exists(folder_ / "out/record.mcap"), end == "simulator_lost");
    EXPECT_TRUE(wait_until_gone(mark_));
    return reason;
  }

  const std::string mark_ =
      std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) +
      std::to_string(getpid());
  TempFolder folder_;
};

// ---- What is not there

TEST_F(StandInGazebo, WithoutGzserverSaysHowToGetIt) {
  const Output output =
      run(command({{"TETHER_GAZEBO_ROOT", folder_ / "nothing"}, {"TETHER_GAZEBO_PLUGIN", ""}}));
  EXPECT_THAT(expect_failure(output, "setup_failed"),
              AllOf(HasSubstr(folder_ / "nothing"), HasSubstr("scripts/gazebo-root")));
}

TEST_F(StandInGazebo, WithoutThePluginNamesIt) {
  const Output output = run(command(stand_in("", {{"TETHER_GAZEBO_PLUGIN", "/nowhere/it.so"}})));
  EXPECT_THAT(expect_failure(output, "setup_failed"), HasSubstr("/nowhere/it.so"));
}

TEST_F(StandInGazebo, WithoutXvfbSaysHowToGetIt) {
  const Output output = run(command(stand_in("", {{"PATH", "/nowhere"}})));
  EXPECT_THAT(expect_failure(output, "setup_failed"), HasSubstr("Xvfb"));
}

TEST_F(StandInGazebo, AWorldThatIsTooNewForItIsABadFile) {
  const auto world = folder_ / "new.sdf";
  write_text(world,
             substituted(read_text(hover_world()), {{"version=\"1.7\"", "version=\"1.9\""}}));
  const auto scenario =
      write_hover_scenario(folder_.path(), "good", {{hover_world().string(), world.string()}});
  const Output output = run(gazebo_run(scenario, folder_ / "out", stand_in(""), mark_));
  EXPECT_EQ(output.code, 2);
  EXPECT_THAT(output.err,
              AllOf(HasSubstr(world.string() + ":"), HasSubstr("1.9"), HasSubstr("Gazebo 11")));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

TEST_F(StandInGazebo, AWorldThatItReadsOtherwiseIsABadFile) {
  const auto world = folder_ / "actor.sdf";
  write_text(world, substituted(read_text(hover_world()),
                                {{"</world>", "<actor name=\"walker\"/></world>"}}));
  const auto scenario =
      write_hover_scenario(folder_.path(), "good", {{hover_world().string(), world.string()}});
  const Output output = run(gazebo_run(scenario, folder_ / "out", stand_in(""), mark_));
  EXPECT_EQ(output.code, 2);
  EXPECT_THAT(output.err, AllOf(HasSubstr(world.string() + ":"), HasSubstr("<actor>")));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

// ---- What fails by itself

struct Fault {
  std::string mode;  ///< of stand_in_simulator.cpp
  std::string end;
  std::vector<std::string> reason;  ///< parts of it, each once
};

void PrintTo(const Fault& fault, std::ostream* out) {
  *out << fault.mode;
}

class FailingGazebo : public StandInGazebo, public testing::WithParamInterface<Fault> {};

TEST_P(FailingGazebo, EndsTheRunWithItsReason) {
  const Fault& fault = GetParam();
  const Variables limit = {{"TETHER_GAZEBO_START_LIMIT_S", "3"}};
  const Output output =
      run(command(stand_in(fault.mode, fault.mode == "silent" ? limit : Variables())));
  const std::string reason = expect_failure(output, fault.end);
  for (const std::string& part : fault.reason) {
    EXPECT_THAT(reason, HasSubstr(part));
    EXPECT_EQ(reason.find(part), reason.rfind(part)) << reason;
  }
  EXPECT_LT(output.wall.count(), 90);
  if (fault.end != "simulator_lost") return;
  EXPECT_EQ(read_record(folder_ / "out").damage, "");
  EXPECT_EQ(read_result(folder_ / "out")["versions"]["simulator"], "a stand-in, grey");
  EXPECT_FALSE(std::filesystem::exists(private_folder(folder_ / "out")));
}

const Fault kFaults[] = {
    {"exit_at_start", "setup_failed", {"code 7", "no wheels", "simulator.log"}},
    {"crash_at_start", "setup_failed", {"signal 11", "the wheels came off"}},
    {"silent", "setup_failed", {"TETHER_GAZEBO_START_LIMIT_S"}},
    {"misread", "setup_failed", {"hover.sdf: Unable to find uri[model://wheels]"}},
    {"no_plugin", "setup_failed", {"Failed to load plugin libwheels.so: no such file"}},
    {"no_gl", "setup_failed", {"rendering is off"}},
    {"port_in_use", "setup_failed", {"http://127.0.0.1:"}},
    {"exit_in_flight", "simulator_lost", {"code 5", "I have had enough"}},
    {"crash_in_flight", "simulator_lost", {"signal 11", "wheels came off"}},
    {"refuse_in_flight", "simulator_lost", {"the world has come to its end"}},
    {"old_words", "simulator_lost", {"signal 6"}},
    // hang_limit_s of the scenario.
    {"stop_in_flight", "simulator_lost", {"2 s"}},
};

INSTANTIATE_TEST_SUITE_P(Modes, FailingGazebo, testing::ValuesIn(kFaults),
                         [](const auto& fault) { return fault.param.mode; });

TEST_F(StandInGazebo, APortOfTheUsersThatIsInUseIsNamed) {
  const Output output =
      run(command(stand_in("port_in_use", {{"GAZEBO_MASTER_URI", "http://localhost:11345"}})));
  EXPECT_THAT(expect_failure(output, "setup_failed"),
              AllOf(HasSubstr("http://localhost:11345"), HasSubstr("GAZEBO_MASTER_URI")));
}

TEST_F(StandInGazebo, IsNotStartedForAMasterElsewhere) {
  const Output output = run(command(stand_in("", {{"GAZEBO_MASTER_URI", "foo"}})));
  EXPECT_THAT(expect_failure(output, "setup_failed"),
              AllOf(HasSubstr("GAZEBO_MASTER_URI"), HasSubstr("\"foo\"")));
}

TEST_F(StandInGazebo, WordsFromBeforeTheFlightAreNotItsLast) {
  const Output output = run(command(stand_in("old_words")));
  EXPECT_THAT(expect_failure(output, "simulator_lost"), Not(HasSubstr("an old line")));
  EXPECT_THAT(read_text(folder_ / "out/simulator.log"), HasSubstr("an old line"));
}

// ---- What ends although it does not want to

class EndingGazebo : public StandInGazebo, public testing::WithParamInterface<std::string> {};

TEST_P(EndingGazebo, LeavesNothing) {
  const Output output = run(command(stand_in(GetParam())));
  EXPECT_EQ(output.code, 0) << output.err;
  EXPECT_EQ(output.err, "");
  EXPECT_TRUE(wait_until_gone(mark_));
  EXPECT_FALSE(std::filesystem::exists(private_folder(folder_ / "out")));
}

INSTANTIATE_TEST_SUITE_P(Modes, EndingGazebo, testing::Values("good", "stubborn", "child"),
                         [](const auto& mode) { return mode.param; });

TEST_F(StandInGazebo, ALostXServerEndsTheRun) {
  EndlessFlight flight(folder_.path(), stand_in(""), mark_);
  const auto x_server = find_process(mark_, "Xvfb");
  ASSERT_TRUE(x_server);
  kill(*x_server, SIGKILL);
  const Output output = flight.process().wait(30s);
  EXPECT_THAT(expect_failure(output, "simulator_lost"), HasSubstr("signal 9"));
}

// ---- What the user ends

TEST_F(StandInGazebo, CtrlCEndsTheRunWithAllItsProcesses) {
  EndlessFlight flight(folder_.path(), stand_in(""), mark_);
  const auto x_server = find_process(mark_, "Xvfb");
  ASSERT_TRUE(x_server);
  flight.process().signal(SIGINT);
  const Output output = flight.process().wait(10s);
  EXPECT_EQ(output.code, 3);
  EXPECT_EQ(read_result(flight.out())["end"], "interrupted");
  EXPECT_EQ(read_record(flight.out()).footer->end, "interrupted");
  EXPECT_TRUE(wait_until_gone(mark_));
  EXPECT_FALSE(has_x_lock(*x_server));
  EXPECT_FALSE(std::filesystem::exists(private_folder(flight.out())));
}

TEST_F(StandInGazebo, CtrlCEndsItWhileItStarts) {
  Process process(command(stand_in("silent")));
  const auto deadline = std::chrono::steady_clock::now() + 30s;
  while (!find_process(mark_, "gzserver") && std::chrono::steady_clock::now() < deadline)
    std::this_thread::sleep_for(10ms);
  process.signal(SIGINT);
  const Output output = process.wait(10s);
  expect_failure(output, "interrupted");
}

TEST_F(StandInGazebo, CtrlCDoesNotWaitForOneThatHangs) {
  const auto scenario =
      write_hover_scenario(folder_.path(), "fly_on", {{"hang_limit_s = 2", "hang_limit_s = 300"}});
  Process process(gazebo_run(scenario, folder_ / "out", stand_in("stop_in_flight"), mark_));
  const auto deadline = std::chrono::steady_clock::now() + 30s;
  const auto is_stopped = [&] {
    const auto gazebo = find_process(mark_, "gzserver");
    return gazebo &&
           read_text("/proc/" + std::to_string(*gazebo) + "/status").find("T (stopped)") !=
               std::string::npos;
  };
  while (!is_stopped() && std::chrono::steady_clock::now() < deadline)
    std::this_thread::sleep_for(10ms);
  process.signal(SIGINT);
  const Output output = process.wait(10s);
  EXPECT_EQ(output.code, 3);
  EXPECT_FALSE(output.timed_out);
  EXPECT_EQ(read_result(folder_ / "out")["end"], "interrupted");
  EXPECT_TRUE(wait_until_gone(mark_));
}

TEST_F(StandInGazebo, ATetherThatIsKilledTakesAllWithIt) {
  EndlessFlight flight(folder_.path(), stand_in(""), mark_);
  const auto left = private_folder(flight.out());
  const auto x_server = find_process(mark_, "Xvfb");
  ASSERT_TRUE(x_server);
  flight.process().signal(SIGKILL);
  EXPECT_TRUE(wait_until_gone(mark_));
  EXPECT_FALSE(has_x_lock(*x_server));
  EXPECT_FALSE(std::filesystem::exists(flight.out() / "result.json"));

  // Its folder goes with the next run.
  EXPECT_TRUE(std::filesystem::exists(left));
  const TempFolder other;
  const Output output = run(gazebo_run(write_hover_scenario(other.path(), "good"), other / "out",
                                       stand_in_gazebo(other.path(), ""), mark_));
  EXPECT_EQ(output.code, 0) << output.err;
  EXPECT_FALSE(std::filesystem::exists(left));
}

// ---- Several

TEST_F(StandInGazebo, TwoRunsDoNotMeet) {
  EndlessFlight flight(folder_.path(), stand_in(""), mark_);
  const TempFolder other;
  const Output output = run(gazebo_run(write_hover_scenario(other.path(), "good"), other / "out",
                                       stand_in_gazebo(other.path(), ""), mark_ + "other"));
  EXPECT_EQ(output.code, 0) << output.err;
  EXPECT_TRUE(wait_until_gone(mark_ + "other"));
  EXPECT_TRUE(std::filesystem::exists(private_folder(flight.out())));
  EXPECT_FALSE(flight.process().has_ended());
  flight.process().signal(SIGINT);
  EXPECT_EQ(flight.process().wait(10s).code, 3);
}

}  // namespace
}  // namespace tether::system_test
