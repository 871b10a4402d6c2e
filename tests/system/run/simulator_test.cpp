#include "support/gazebo.h"

#include <csignal>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// `--simulator`: which simulator plays the world, in runs and campaigns.
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;
using testing::AllOf;
using testing::HasSubstr;

/// A simulator that somebody has started.
class AttachedSimulator : public testing::Test {
 protected:
  AttachedSimulator()
      : address_("unix:" + (folder_ / "simulator").string()),
        process_({.arguments = {stand_in_program(), address_},
                  .environment = {{"TETHER_TEST_MARK", "simulator"}},
                  .working_folder = {}}) {
    EXPECT_TRUE(process_.wait_for_out("listening on " + address_, 30s));
  }
  Output fly(const std::string& mode = "good") {
    return run(tether({"run", write_hover_scenario(folder_.path(), mode), "--simulator", address_,
                       "--out", folder_ / "out", "--quiet"}));
  }

  TempFolder folder_;
  std::string address_;
  Process process_;
};

TEST_F(AttachedSimulator, FliesTheRunAndIsNamedInItsResult) {
  const Output output = fly();
  EXPECT_EQ(output.code, 0) << output.err;
  EXPECT_EQ(read_result(folder_ / "out")["versions"]["simulator"], "a stand-in, grey");
  EXPECT_EQ(read_record(folder_ / "out").header.simulator, "a stand-in, grey");
  EXPECT_EQ(run(tether({"audit", folder_ / "out/record.mcap"})).code, 0);
}

TEST_F(AttachedSimulator, IsLeftRunningForTheNextRun) {
  EXPECT_EQ(fly().code, 0);
  EXPECT_EQ(fly().code, 0);
  EXPECT_FALSE(process_.has_ended());
}

TEST_F(AttachedSimulator, ThatIsNotThereIsNamed) {
  process_.signal(SIGKILL);
  process_.wait(10s);
  const Output output = fly();
  EXPECT_EQ(output.code, 3);
  EXPECT_THAT(output.err, HasSubstr(address_));
  EXPECT_EQ(read_result(folder_ / "out")["end"], "setup_failed");
}

TEST(Simulator, ThatDoesNotExistIsWrongUse) {
  const TempFolder folder;
  const Output output = run(tether({"run", write_hover_scenario(folder.path(), "good"),
                                    "--simulator", "gazeebo", "--out", folder / "out"}));
  EXPECT_EQ(output.code, 2);
  EXPECT_THAT(output.err, AllOf(HasSubstr("gazeebo"), HasSubstr("mujoco")));
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

// ---- Of a condition

TEST(SimulatorOfACondition, GivesWayToTheCommandLine) {
  const TempFolder folder;
  const auto scenario = write_hover_scenario(
      folder.path(), "good", {{"clock = \"cpu\"", "clock = \"cpu\"\nsimulator = \"gazebo\""}});
  Command in_gazebo = tether({"run", scenario, "--out", folder / "one"});
  for (const auto& variable : stand_in_gazebo(folder.path(), ""))
    in_gazebo.environment.push_back(variable);
  EXPECT_EQ(run(in_gazebo).code, 0);
  EXPECT_EQ(read_result(folder / "one")["versions"]["simulator"], "a stand-in, grey");

  EXPECT_EQ(run(tether({"run", scenario, "--simulator", "mujoco", "--out", folder / "two"})).code,
            0);
  EXPECT_THAT(read_result(folder / "two")["versions"]["simulator"].get<std::string>(),
              HasSubstr("MuJoCo"));
}

// ---- Of a campaign

class CampaignInGazebo : public testing::Test {
 protected:
  CampaignInGazebo() : variables_(stand_in_gazebo(folder_.path(), "")) {
    write_hover_scenario(folder_.path(), "good");
    write_text(folder_ / "campaign.toml",
               "name = \"small\"\ntrials = 2\n\n[[scenario]]\nfile = \"hover.toml\"\n");
  }
  Output fly(const std::vector<std::string>& options, const Variables& more = {}) {
    Command command =
        tether({"campaign", folder_ / "campaign.toml", "--out", folder_ / "out"}, mark_);
    command.arguments.insert(command.arguments.end(), options.begin(), options.end());
    command.environment.insert(command.environment.end(), variables_.begin(), variables_.end());
    command.environment.insert(command.environment.end(), more.begin(), more.end());
    return run(command, 100s);
  }

  const std::string mark_ = "campaign" + std::to_string(getpid());
  TempFolder folder_;
  Variables variables_;
};

TEST_F(CampaignInGazebo, GivesEachTrialAGazeboOfItsOwn) {
  const Output output = fly({"--simulator", "gazebo", "--jobs", "2"});
  ASSERT_EQ(output.code, 0) << output.err;
  for (const char* trial :
       {"host/seed-0001", "host/seed-0002", "slow/seed-0001", "slow/seed-0002"}) {
    const auto folder = folder_ / "out/hover" / trial;
    EXPECT_EQ(read_result(folder)["versions"]["simulator"], "a stand-in, grey");
    EXPECT_FALSE(std::filesystem::exists(private_folder(folder)));
  }
  EXPECT_TRUE(wait_until_gone(mark_));
}

TEST_F(CampaignInGazebo, IsNotGoneOnWithInAnotherSimulator) {
  ASSERT_EQ(fly({"--simulator", "gazebo"}).code, 0);
  const Output output = fly({"--resume"});
  EXPECT_EQ(output.code, 2);
  EXPECT_THAT(output.err, HasSubstr("simulator"));
  EXPECT_EQ(fly({"--simulator", "gazebo", "--resume"}).code, 0);
}

TEST_F(CampaignInGazebo, RefusesJobsThatWouldShareAPortOrASimulator) {
  const Output port = fly({"--simulator", "gazebo", "--jobs", "2"},
                          {{"GAZEBO_MASTER_URI", "http://localhost:11345"}});
  EXPECT_EQ(port.code, 2);
  EXPECT_THAT(port.err, HasSubstr("http://localhost:11345"));
  const Output address = fly({"--simulator", "tcp://127.0.0.1:1", "--jobs", "2"});
  EXPECT_EQ(address.code, 2);
  EXPECT_THAT(address.err, HasSubstr("tcp://127.0.0.1:1"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

TEST_F(CampaignInGazebo, WithoutGazeboDoesNotBegin) {
  const Output output =
      fly({"--simulator", "gazebo"}, {{"TETHER_GAZEBO_ROOT", folder_ / "nothing"}});
  EXPECT_EQ(output.code, 3);
  EXPECT_THAT(output.err, HasSubstr("scripts/gazebo-root"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

}  // namespace
}  // namespace tether::system_test
