#include "support/faults.h"
#include "support/gazebo.h"

#include <csignal>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/ptrace.h>
#include <sys/wait.h>

/// The software under test fails, is killed, stopped or looked into by a debugger, at each phase
/// (docs/guide/faults.md): the run ends in bounded time with a reason that names it.
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

class SutAtEachPhase : public RunTest, public testing::WithParamInterface<StruckSut> {};

TEST_P(SutAtEachPhase, AStruckSutIsNamed) {
  const auto& [mode, failure, recorded_end] = GetParam();
  expect_failed(run(flight(mode, {"--real-time-factor", "1"},
                           {{"hang_limit_s = 2", "hang_limit_s = 2\nconnect_limit_s = 5"}})),
                failure);
  EXPECT_THAT(reason(), HasSubstr("\"uav1\""));
  EXPECT_NE(std::filesystem::exists(out_ / "record.mcap"), recorded_end.empty());
  if (recorded_end.empty()) return;
  const record::Record record = read_record(out_);
  EXPECT_EQ(record.damage, "");
  EXPECT_EQ(record.footer->end, recorded_end);
  EXPECT_EQ(audit_code(out_), 0);
}

const std::string kKilled = "signal 9 (Killed)";

// A SUT that is lost before its first interaction was never there, as far as campaigns go.
const StruckSut kStruckSuts[] = {
    {"exit_at_start", {"setup_failed", {"code 7", "cannot open the camera"}}, ""},
    {"garbage_after_hello", {"setup_failed", {"2021161080"}}, "sut_lost"},
    {"kill_connecting", {"setup_failed", {kKilled}}, ""},
    {"kill_connected", {"setup_failed", {kKilled}}, ""},
    {"kill_joined", {"setup_failed", {kKilled, "ET 0.000000 s"}}, "sut_lost"},
    {"kill_computing", {"sut_lost", {kKilled, "ET 1."}}, "sut_lost"},
    {"kill_held", {"setup_failed", {kKilled, "ET 4.000000 s"}}, "sut_lost"},
    {"kill_request_half", {"setup_failed", {kKilled, "ET 0.000000 s"}}, "sut_lost"},
    {"kill_reply_half", {"sut_lost", {kKilled}}, "sut_lost"},
    {"crash", {"sut_lost", {"signal 11"}}, "sut_lost"},
    {"exit", {"sut_lost", {}}, "sut_lost"},
    {"deaf", {"sut_lost", {"SIGCHLD"}}, "sut_lost"},
    {"stop_connected", {"setup_failed", {"5 s"}}, ""},
    {"stop_joined", {"sut_hung", {"2 s (hang_limit_s)"}}, "sut_hung"},
    {"stop_computing", {"sut_hung", {"ET 1."}}, "sut_hung"},
    // Its reply left in time; nothing came after it.
    {"stop_held", {"sut_hung", {"ET 4.000000 s"}}, "sut_hung"},
    {"stop_request_half", {"sut_hung", {"ET 0.000000 s"}}, "sut_hung"},
    {"stop_reply_half", {"sut_hung", {}}, "sut_hung"},
};

INSTANTIATE_TEST_SUITE_P(Phases, SutAtEachPhase, testing::ValuesIn(kStruckSuts),
                         [](const auto& struck) { return struck.param.mode; });

// ---- Past the time limit

class PastTheTimeLimit : public RunTest, public testing::WithParamInterface<std::string> {};

TEST_P(PastTheTimeLimit, MissesItsGoal) {
  // CPU time that is stretched tenfold: 5 s of it are soon over.
  const Output output = run(flight(GetParam(), {"--condition", "slow"}));
  EXPECT_EQ(output.code, 1);
  EXPECT_EQ(result()["end"], "time_limit");
  EXPECT_EQ(result()["outcome"], "goal_missed");
  EXPECT_THAT(reason(), HasSubstr("5 s"));
  EXPECT_EQ(result()["sync"]["st_at_end_s"], 5.0);
  EXPECT_EQ(audit_code(out_), 0);
  EXPECT_TRUE(wait_until_gone(mark_));
}

INSTANTIATE_TEST_SUITE_P(Modes, PastTheTimeLimit,
                         testing::Values("sleep_long", "fly_on", "stubborn"));

// ---- When it has sent its finish, or left a child behind

class OnceItHasFinished : public RunTest, public testing::WithParamInterface<std::string> {};

TEST_P(OnceItHasFinished, AStruckSutSpoilsNothing) {
  const Output output = run(flight(GetParam(), {"--real-time-factor", "1"}, {kScripted}));
  EXPECT_EQ(output.code, 0) << output.err;
  EXPECT_TRUE(wait_until_gone(mark_));
  EXPECT_EQ(result()["outcome"], "goal_reached");
  const bool is_named = result().dump().find("after its program had finished") != std::string::npos;
  EXPECT_EQ(is_named, GetParam() != "child");
}

INSTANTIATE_TEST_SUITE_P(Modes, OnceItHasFinished,
                         testing::Values("child", "kill_finishing", "stop_finishing",
                                         "kill_finished", "linger"),
                         [](const auto& mode) { return mode.param; });

// ---- Stopped for a while

class StoppedSut : public RunTest {
 protected:
  /// Its SUT, once that has printed so.
  pid_t sut_after(const std::string& printed) const {
    EXPECT_TRUE(sut_prints(out_, printed));
    const auto sut = find_process(mark_, "bad_sut");
    if (!sut) throw std::runtime_error("no SUT");
    return *sut;
  }
  /// A good end, and a note that names the process.
  void expect_noted(Process& process, pid_t sut) {
    EXPECT_EQ(process.wait(60s).code, 0) << process.err();
    EXPECT_THAT(result()["this_run"]["notes"].dump(), HasSubstr(std::to_string(sut)));
    EXPECT_THAT(result()["this_run"]["stopped_program"], HasSubstr(std::to_string(sut)));
  }
};

// By a scripted clock the run is the same after a stop, and after a debugger.
TEST_F(StoppedSut, ChangesNothingUnderAScriptedClock) {
  const Command command = flight("good", {"--real-time-factor", "1"},
                                 {kScripted, {"hang_limit_s = 2", "hang_limit_s = 60"}});
  EXPECT_EQ(run(command).code, 0);
  const auto alone = folder_ / "alone";
  std::filesystem::rename(out_, alone);
  for (const bool debugged : {false, true}) {
    Process process(command);
    const pid_t sut = sut_after("joined");
    if (!debugged) {
      kill(sut, SIGSTOP);
    } else if (ptrace(PTRACE_SEIZE, sut, nullptr, nullptr) != 0) {
      expect_not_in_ci();
      GTEST_SKIP() << "no ptrace here";
    } else {
      ASSERT_EQ(ptrace(PTRACE_INTERRUPT, sut, nullptr, nullptr), 0);
      ASSERT_EQ(waitpid(sut, nullptr, __WALL), sut);
    }
    EXPECT_TRUE(process.wait_for_err("\"uav1\"", 30s)) << process.err();
    EXPECT_TRUE(process.wait_for_err(std::to_string(sut), 5s)) << process.err();
    EXPECT_EQ(debugged ? ptrace(PTRACE_DETACH, sut, nullptr, nullptr) : kill(sut, SIGCONT), 0);
    expect_noted(process, sut);
    expect_same_runs(alone, out_);
    std::filesystem::remove_all(out_);
  }
}

// The image takes 3.7 s to arrive, and hang_limit_s is 2.
TEST_F(RunTest, TransitOnASlowLinkIsNotSilence) {
  ExternalRun run(write_hover_scenario(folder_.path(), "unused", {kWall}), out_);
  const SlowWire wire(run.address(), 1, 2);
  const auto sut = run.start_sut({bad_sut_program(), "look"}, {{"TETHER_ADDRESS", wire.address()}});
  EXPECT_EQ(run.wait().code, 0) << reason();
}

// By a wall clock, the time in which it was stopped counts as computing.
TEST_F(StoppedSut, IsChargedForItByAWallClock) {
  Process process(flight("pause", {}, {kWall, {"hang_limit_s = 2", "hang_limit_s = 60"}}));
  const pid_t sut = sut_after("pausing");
  kill(sut, SIGSTOP);
  std::this_thread::sleep_for(2500ms);
  kill(sut, SIGCONT);
  expect_noted(process, sut);
  // It flies for at least 1.3 s, and has a pause of its own of 1 s, which ends meanwhile.
  EXPECT_GE(result()["sync"]["st_at_end_s"].get<double>(), 1.3 + 2.5);
}

// ---- A crash

struct Ram {
  std::string limit;  ///< in the scenario
  int code;
  std::string outcome;
};

TEST_F(RunTest, AHardContactMissesTheGoalWhateverTheSutReports) {
  for (const Ram& ram :
       {Ram{"", 1, "goal_missed"}, Ram{"max_contact_speed_m_s = inf\n", 0, "goal_reached"}}) {
    const Output output =
        run(flight("ram", {}, {kScripted, {"hang_limit_s", ram.limit + "hang_limit_s"}}));
    EXPECT_EQ(output.code, ram.code) << output.err;
    const auto contacts = result()["contacts"][0];
    EXPECT_EQ(result()["outcome"], ram.outcome);
    EXPECT_TRUE(result()["suts"][0]["reached_goal"]);
    EXPECT_EQ(contacts["hardest"]["with"], "floor");
    EXPECT_GT(contacts["hardest"]["speed_m_s"], 1.0);
    EXPECT_EQ(contacts["hard"], ram.code);
    EXPECT_EQ(contacts["min_clearance_m"], 0.0);
    EXPECT_EQ(reason().find("'uav1' hit 'floor' at ST ") == 0, ram.code == 1) << reason();
    const record::Record record = read_record(out_);
    ASSERT_FALSE(record.contacts.empty());
    EXPECT_EQ(record.contacts[0].message.speed_m_s, contacts["hardest"]["speed_m_s"]);
    EXPECT_EQ(audit_code(out_), 0);
    std::filesystem::remove_all(out_);
  }
}

}  // namespace
}  // namespace tether::system_test
