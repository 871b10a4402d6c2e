#include "fake_back_end.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/base_testing/thrown_error.h>
#include <tether/os/text_file.h>
#include <tether/runner/trial.h>
#include <tether/runner/trial_folder.h>

/// Trials that end before a SUT joins. Complete ones are in tests/system.
namespace tether::runner {
namespace {

using testing::HasSubstr;

class Trial : public testing::Test {
 protected:
  Trial() {
    spec_.scenario = scenario::load_scenario(std::filesystem::path(TETHER_SOURCE_DIR) /
                                             "data/scenarios/face_anchor.toml");
    fly_in_empty_world(spec_.scenario, scratch_);
    spec_.condition = spec_.scenario.conditions.front();
    spec_.condition.simulator = "fake";
    spec_.folder = scratch_.path("out");
    spec_.earlier = EarlierRun::kReplace;
    run_as_sut("exec sleep 600");
  }
  void run_as_sut(const std::string& script) {
    spec_.scenario.uavs.at(0).sut.command = {"sh", "-c", script};
  }
  campaign::TrialResult run(const FindBackEnd& back_end = fake_back_end()) {
    auto result = run_trial(spec_, back_end, observer_, stop_.get_token());
    EXPECT_EQ(campaign::read_result(spec_.folder).reason, result.reason);
    EXPECT_FALSE(std::filesystem::exists(spec_.folder / kRecordFile));
    return result;
  }

  ScratchFolder scratch_;
  TrialSpec spec_;
  TrialObserver observer_{};
  std::stop_source stop_;
};

TEST_F(Trial, FailsIfItsSutEndsBeforeItJoins) {
  run_as_sut("echo no camera; exit 3");
  const auto result = run();
  EXPECT_EQ(result.outcome, campaign::Outcome::kFailed);
  EXPECT_EQ(result.end, campaign::kEndSetupFailed);
  EXPECT_THAT(result.reason, HasSubstr("exited with code 3"));
  EXPECT_THAT(result.reason, testing::EndsWith("sut-uav1.log: no camera"));
}

TEST_F(Trial, FailsIfTheSimulatorIsLostOrCannotBeStarted) {
  auto result = run(fake_back_end("the simulator was ended by signal 9"));
  EXPECT_EQ(result.end, campaign::kEndSetupFailed);
  EXPECT_EQ(result.reason, "the simulator was ended by signal 9; more");
  result = run([](const std::string& name) {
    BackEnd back_end = fake_back_end()(name);
    back_end.prepare = [](const sim::World&, const sim::WarningSink&) -> StartSimulator {
      return [](const SimulatorSetup&) -> std::unique_ptr<RunningSimulator> {
        throw Error(ErrorCode::kSetup, "not installed");
      };
    };
    return back_end;
  });
  EXPECT_EQ(result.end, campaign::kEndSetupFailed);
  EXPECT_EQ(result.reason, "not installed");
}

// If the user starts the SUT, with its command line.
TEST_F(Trial, IsInterruptedByAStopRequest) {
  observer_.on_status = [&](const coordinator::RunStatus&) { stop_.request_stop(); };
  for (const bool waits_for_sut : {false, true}) {
    spec_.waits_for_sut = waits_for_sut;
    std::string instructions;
    observer_.on_listening = [&](const std::string& text) { instructions = text; };
    EXPECT_EQ(run().end, campaign::kEndInterrupted);
    for (const char* name : {"TETHER_ADDRESS=127.0.0.1:", "TETHER_UAV=", "TETHER_TOKEN="})
      EXPECT_EQ(instructions.find(name) != std::string::npos, waits_for_sut) << name;
  }
}

TEST_F(Trial, KeepsWarningsAndPassesThemOnBeforeTheRun) {
  spec_.scenario.world = scratch_.write(
      "w.sdf", "<sdf version='1.7'>\n<world name='w'>\n<bogus/>\n<bogus/></world></sdf>");
  std::vector<Warning> passed_on;
  observer_.on_warnings = [&](const std::vector<Warning>& warnings) { passed_on = warnings; };
  observer_.on_status = [&](const coordinator::RunStatus&) {
    EXPECT_EQ(passed_on.size(), 2u);
    stop_.request_stop();
  };
  const auto result = run();
  EXPECT_EQ(result.warnings, passed_on);
  EXPECT_EQ(result.warnings.at(0).where.line, 3);
  EXPECT_EQ(campaign::read_result(spec_.folder).warnings, passed_on);
  const std::string list = os::read_file(spec_.folder / kWarningsFile);
  for (const Warning& warning : passed_on) EXPECT_THAT(list, HasSubstr(to_line(warning)));
}

// A plugin that moves something, for example: the embedded simulator has none, Gazebo has.
TEST_F(Trial, DoubtsNoVerdictForWhatTheSimulatorItselfReadsOfTheWorld) {
  spec_.scenario.world =
      scratch_.write("w.sdf",
                     "<sdf version='1.7'><world name='w'>"
                     "<physics name='p' type='ode'><max_step_size>0.002</max_step_size></physics>"
                     "<plugin name='p' filename='libmoving_platform.so'/></world></sdf>");
  spec_.scenario.step.reset();
  observer_.on_status = [&](const coordinator::RunStatus&) { stop_.request_stop(); };
  for (const bool reads_world : {false, true}) {
    const auto result = run([&](const std::string& name) {
      BackEnd back_end = fake_back_end()(name);
      back_end.reads_world = reads_world;
      return back_end;
    });
    ASSERT_EQ(result.warnings.size(), 1u);
    EXPECT_EQ(result.warnings[0].can_change_verdict, !reads_world);
    EXPECT_EQ(result.step, (campaign::StepReport{std::chrono::milliseconds(2), "world"}));
  }
}

TEST_F(Trial, WritesNothingIfAnOptionOrAFileIsWrong) {
  const auto subject = [&](ErrorCode code) {
    return thrown_error(code,
                        [&] { run_trial(spec_, fake_back_end(), observer_, stop_.get_token()); })
        .subject();
  };
  spec_.condition.simulator = "another";
  EXPECT_EQ(subject(ErrorCode::kUsage), "another");
  spec_.condition.simulator = "fake";
  spec_.scenario.uavs.at(0).sut.command = {"no-such-program-of-tether"};
  EXPECT_EQ(subject(ErrorCode::kBadFile), spec_.scenario.uavs.at(0).placement.name);
  EXPECT_FALSE(std::filesystem::exists(spec_.folder));
}

}  // namespace
}  // namespace tether::runner
