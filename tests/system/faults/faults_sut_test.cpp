#include "support/faults.h"
#include "support/gazebo.h"

#include <csignal>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/ptrace.h>
#include <sys/wait.h>

/// The software under test is killed, stopped or looked into by a debugger, whatever it does just
/// then (docs/guide/faults.md).
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

// ---- At each phase

struct StruckSut {
  std::string mode;  ///< of bad_sut.cpp
  Failure failure;
  std::string recorded_end;  ///< empty: there is no record
};

void PrintTo(const StruckSut& struck, std::ostream* out) {
  *out << struck.mode;
}

class AtEachPhase : public testing::TestWithParam<StruckSut> {};

TEST_P(AtEachPhase, AStruckSutIsNamed) {
  const TempFolder folder;
  const std::string mark = mark_of_test();
  const Output output = run(tether({"run", write_hover_scenario(folder.path(), GetParam().mode),
                                    "--out", folder / "out", "--real-time-factor", "1"},
                                   mark));
  const auto result = expect_failed(output, folder / "out", GetParam().failure, mark);
  EXPECT_THAT(result["reason"].get<std::string>(), HasSubstr("\"uav1\""));
  const std::string& recorded_end = GetParam().recorded_end;
  EXPECT_NE(std::filesystem::exists(folder / "out/record.mcap"), recorded_end.empty());
  if (recorded_end.empty()) return;
  EXPECT_EQ(read_record(folder / "out").footer->end, recorded_end);
  EXPECT_EQ(run(tether({"audit", folder / "out/record.mcap"})).code, 0);
}

const std::string kKilled = "signal 9 (Killed)";

// A SUT that is lost before its first interaction was never there, as far as campaigns go.
const StruckSut kStruckSuts[] = {
    {"kill_connecting", {"setup_failed", {kKilled}}, ""},
    {"kill_connected", {"setup_failed", {kKilled}}, ""},
    {"kill_joined", {"setup_failed", {kKilled, "ET 0.000000 s"}}, "sut_lost"},
    {"kill_computing", {"sut_lost", {kKilled, "ET 1."}}, "sut_lost"},
    {"kill_held", {"setup_failed", {kKilled, "ET 4.000000 s"}}, "sut_lost"},
    {"kill_request_half", {"setup_failed", {kKilled, "ET 0.000000 s"}}, "sut_lost"},
    {"kill_reply_half", {"sut_lost", {kKilled}}, "sut_lost"},
    // 30 s are allowed for joining.
    {"stop_connected", {"setup_failed", {"30 s"}}, ""},
    {"stop_joined", {"sut_hung", {"2.0 s"}}, "sut_hung"},
    {"stop_computing", {"sut_hung", {"ET 1."}}, "sut_hung"},
    // Its reply left in time; nothing came after it.
    {"stop_held", {"sut_hung", {"ET 4.000000 s"}}, "sut_hung"},
    {"stop_request_half", {"sut_hung", {"ET 0.000000 s"}}, "sut_hung"},
    {"stop_reply_half", {"sut_hung", {}}, "sut_hung"},
};

INSTANTIATE_TEST_SUITE_P(Phases, AtEachPhase, testing::ValuesIn(kStruckSuts),
                         [](const auto& struck) { return struck.param.mode; });

// ---- When it has sent its finish

class OnceItHasFinished : public testing::TestWithParam<std::string> {};

TEST_P(OnceItHasFinished, AStruckSutSpoilsNothing) {
  const TempFolder folder;
  const std::string mark = mark_of_test();
  const Output output = run(tether({"run", write_hover_scenario(folder.path(), GetParam()), "--out",
                                    folder / "out", "--real-time-factor", "1"},
                                   mark));
  EXPECT_EQ(output.code, 0) << output.err;
  EXPECT_TRUE(wait_until_gone(mark));
  const auto result = read_result(folder / "out");
  EXPECT_EQ(result["outcome"], "goal_reached");
  EXPECT_THAT(result["this_run"]["notes"].dump(), HasSubstr("uav1"));
}

// While its finish is held at the barrier, and once it was confirmed.
INSTANTIATE_TEST_SUITE_P(Modes, OnceItHasFinished,
                         testing::Values("kill_finishing", "stop_finishing", "kill_finished",
                                         "stop_finished", "linger"),
                         [](const auto& mode) { return mode.param; });

// ---- Stopped for a while

/// The good SUT under a scripted clock, slow enough to be disturbed.
class ScriptedFlight : public testing::Test {
 protected:
  Command command(const std::string& out) {
    const auto scenario =
        write_hover_scenario(folder_.path(), "good",
                             {{"clock = \"cpu\"", "clock = \"scripted\"\ncomputing_ms = 2"},
                              {"hang_limit_s = 2", "hang_limit_s = 60"}});
    return tether({"run", scenario, "--out", folder_ / out, "--real-time-factor", "0.5"}, mark_);
  }
  /// Its SUT, once it flies.
  pid_t flying_sut(const std::string& out) const {
    EXPECT_TRUE(wait_until([&] {
      return read_text(folder_ / out / "sut-uav1.log").find("joined") != std::string::npos;
    }));
    return find_process(mark_, "bad_sut").value_or(-1);
  }
  void expect_as_if_alone(const std::string& out) {
    EXPECT_EQ(run(command("alone")).code, 0);
    EXPECT_EQ(timeless_result(folder_ / out), timeless_result(folder_ / "alone"));
    EXPECT_EQ(timeless_record(folder_ / out), timeless_record(folder_ / "alone"));
  }

  const std::string mark_ = mark_of_test();
  TempFolder folder_;
};

TEST_F(ScriptedFlight, IsTheSameAfterItsSutWasStopped) {
  Process process(command("stopped"));
  const pid_t sut = flying_sut("stopped");
  ASSERT_GT(sut, 0);
  kill(sut, SIGSTOP);
  EXPECT_TRUE(process.wait_for_err("\"uav1\"", 30s)) << process.err();
  EXPECT_TRUE(process.wait_for_err("process " + std::to_string(sut), 5s)) << process.err();
  kill(sut, SIGCONT);
  EXPECT_EQ(process.wait(60s).code, 0) << process.err();
  EXPECT_THAT(read_result(folder_ / "stopped")["this_run"]["notes"].dump(),
              HasSubstr("process " + std::to_string(sut)));
  expect_as_if_alone("stopped");
}

// By a wall clock, time in which it was stopped is its own: the number is another, and says so.
TEST(WallClockFlight, CountsTheTimeForWhichItsSutWasStopped) {
  const TempFolder folder;
  const std::string mark = mark_of_test();
  const auto scenario = write_hover_scenario(
      folder.path(), "pause",
      {{"clock = \"cpu\"", "clock = \"wall\""}, {"hang_limit_s = 2", "hang_limit_s = 60"}});
  Process process(tether({"run", scenario, "--out", folder / "out"}, mark));
  ASSERT_TRUE(wait_until([&] {
    return read_text(folder / "out/sut-uav1.log").find("pausing") != std::string::npos;
  })) << process.err();
  const auto sut = find_process(mark, "bad_sut");
  ASSERT_TRUE(sut);
  kill(*sut, SIGSTOP);
  std::this_thread::sleep_for(2500ms);
  kill(*sut, SIGCONT);
  EXPECT_EQ(process.wait(60s).code, 0) << process.err();
  const auto result = read_result(folder / "out");
  // It flies for at least 1.3 s, and has a pause of its own of 1 s, which ends meanwhile.
  EXPECT_GE(result["sync"]["st_at_end_s"].get<double>(), 1.3 + 2.5);
  EXPECT_THAT(result["this_run"]["notes"].dump(), HasSubstr("process " + std::to_string(*sut)));
}

TEST_F(ScriptedFlight, IsTheSameAfterADebuggerLookedIn) {
  Process process(command("debugged"));
  const pid_t sut = flying_sut("debugged");
  ASSERT_GT(sut, 0);
  if (ptrace(PTRACE_SEIZE, sut, nullptr, nullptr) != 0) {
    expect_not_in_ci();
    GTEST_SKIP() << "no ptrace here";
  }
  ASSERT_EQ(ptrace(PTRACE_INTERRUPT, sut, nullptr, nullptr), 0);
  ASSERT_EQ(waitpid(sut, nullptr, __WALL), sut);
  EXPECT_TRUE(process.wait_for_err("\"uav1\"", 30s)) << process.err();
  EXPECT_TRUE(process.wait_for_err("process " + std::to_string(sut), 5s)) << process.err();
  EXPECT_EQ(ptrace(PTRACE_DETACH, sut, nullptr, nullptr), 0);
  EXPECT_EQ(process.wait(60s).code, 0) << process.err();
  EXPECT_THAT(read_result(folder_ / "debugged")["this_run"]["notes"].dump(),
              HasSubstr("process " + std::to_string(sut)));
  expect_as_if_alone("debugged");
}

}  // namespace
}  // namespace tether::system_test
