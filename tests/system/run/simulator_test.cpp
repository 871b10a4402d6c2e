#include "support/faults.h"
#include "support/gazebo.h"

#include <csignal>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// `--simulator`: which simulator runs and campaigns use.
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

const std::string kStandIn = "a stand-in, grey";

using Simulator = RunTest;

TEST_F(Simulator, ThatIsRunningFliesOneRunAfterAnother) {
  const std::string address = "unix:" + (folder_ / "simulator").string();
  Process simulator({{stand_in_program(), address}});
  EXPECT_TRUE(simulator.wait_for_out(address, 30s));
  for (int i = 0; i < 2; ++i) {
    const Output output = run(flight("good", {"--simulator", address}));
    EXPECT_EQ(output.code, 0) << output.err;
    EXPECT_EQ(result()["versions"]["simulator"], kStandIn);
    EXPECT_EQ(read_record(out_).header.simulator, kStandIn);
    EXPECT_EQ(audit_code(out_), 0);
  }
  EXPECT_FALSE(simulator.has_ended());

  simulator.signal(SIGKILL);
  simulator.wait(10s);
  expect_failed(run(flight("good", {"--simulator", address})), {"setup_failed", {address}});
}

TEST_F(Simulator, OfTheCommandLineGoesBeforeThatOfACondition) {
  const std::vector<Substitution> gazebo{
      {"clock = \"cpu\"", "clock = \"cpu\"\nsimulator = \"gazebo\""}};
  const Variables stand_in = stand_in_gazebo(folder_.path(), "");
  EXPECT_EQ(run(with(flight("good", {}, gazebo), {}, stand_in)).code, 0);
  EXPECT_EQ(result()["versions"]["simulator"], kStandIn);
  EXPECT_EQ(run(flight("good", {"--simulator", "mujoco"}, gazebo)).code, 0);
  EXPECT_THAT(result()["versions"]["simulator"].get<std::string>(), HasSubstr("MuJoCo"));
}

// ---- Of a campaign

class CampaignInGazebo : public RunTest {
 protected:
  CampaignInGazebo() { write_hover_scenario(folder_.path(), "good"); }
  Output fly(const std::vector<std::string>& options, const Variables& more = {}) {
    const Command command = tether({"campaign", campaign_, "--out", out_}, mark_);
    return run(with(with(command, options, stand_in_), {}, more), 100s);
  }

  const std::filesystem::path campaign_ = write_campaign(folder_.path(), 1);
  const Variables stand_in_ = stand_in_gazebo(folder_.path(), "");
};

TEST_F(CampaignInGazebo, HasAGazeboForEachTrialAndResumesInNoOther) {
  const Output output = fly({"--simulator", "gazebo", "--jobs", "2"});
  ASSERT_EQ(output.code, 0) << output.err;
  for (const char* trial : {"host/seed-0001", "slow/seed-0001"}) {
    const auto folder = out_ / "hover" / trial;
    EXPECT_EQ(read_result(folder)["versions"]["simulator"], kStandIn);
    EXPECT_FALSE(std::filesystem::exists(private_folder(folder)));
  }
  EXPECT_TRUE(wait_until_gone(mark_));
  EXPECT_EQ(fly({"--resume"}).code, 2);
  EXPECT_EQ(fly({"--simulator", "gazebo", "--resume"}).code, 0);
}

TEST_F(CampaignInGazebo, DoesNotBeginWithoutGazeboOrWithJobsThatWouldShareIt) {
  const auto expect_refused = [&](int code, const std::string& named,
                                  const std::vector<std::string>& options, const Variables& more) {
    const Output output = fly(options, more);
    EXPECT_EQ(output.code, code);
    EXPECT_THAT(output.err, HasSubstr(named));
    EXPECT_FALSE(std::filesystem::exists(out_));
  };
  const std::string master = "http://localhost:11345", address = "tcp://127.0.0.1:1";
  expect_refused(2, master, {"--simulator", "gazebo", "--jobs", "2"},
                 {{"GAZEBO_MASTER_URI", master}});
  expect_refused(2, address, {"--simulator", address, "--jobs", "2"}, {});
  expect_refused(3, "scripts/gazebo-root", {"--simulator", "gazebo"},
                 {{"TETHER_GAZEBO_ROOT", folder_ / "nothing"}});
}

// The key is in a profile that only the campaign names.
TEST_F(CampaignInGazebo, DoesNotBeginWithAnAntialiasedCamera) {
  write_campaign(folder_.path(), 1, "profile = \"smooth.toml\"\n");
  const auto profile = folder_ / "smooth.toml";
  write_text(profile, "name = \"smooth\"\n[sensors.camera]\nkind = \"camera\"\nantialias = true\n");
  const Output output = fly({"--simulator", "gazebo"});
  EXPECT_EQ(output.code, 2);
  EXPECT_THAT(output.err, HasSubstr(profile.string() + ":4: "));
  EXPECT_FALSE(std::filesystem::exists(out_));
}

}  // namespace
}  // namespace tether::system_test
