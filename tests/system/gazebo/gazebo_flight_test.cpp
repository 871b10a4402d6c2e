#include "support/gzserver.h"
#include "support/trials.h"

#include <cmath>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// Real flights in a real Gazebo: the same world, the same UAV, the same rules of time as in the
/// embedded simulator.
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;

constexpr auto kLimit = 240s;

/// What a flight under the scenario's condition "host" left in `out`.
void fly(const std::filesystem::path& scenario, const std::filesystem::path& out,
         const std::vector<std::string>& options, const std::vector<std::string>& launcher = {}) {
  const Output output = run(
      started_by(
          launcher,
          with(tether({"run", scenario, "--condition", "host", "--quiet", "--out", out}), options)),
      kLimit);
  ASSERT_EQ(output.code, 0) << output.err;
}

double metric(const std::filesystem::path& out, const std::string& name) {
  const auto result = read_result(out);
  for (const auto& entry : result["metrics"])
    if (entry["name"] == name) return entry["value"];
  ADD_FAILURE() << "no metric " << name;
  return std::nan("");
}

class GazeboFlight : public testing::Test {
 protected:
  void SetUp() override {
    if (const auto why = no_gzserver()) GTEST_SKIP() << *why;
  }
  TempFolder folder_;
};

class ShippedScenario : public GazeboFlight, public testing::WithParamInterface<const char*> {};

TEST_P(ShippedScenario, TakesAsLongAsInTheEmbeddedSimulator) {
  const auto scenario = write_shipped_scenario(folder_.path(), GetParam(), {scripted_host(10)});
  for (const char* simulator : {"mujoco", "gazebo"})
    fly(scenario, folder_ / simulator, {"--simulator", simulator});
  const double embedded_s = metric(folder_ / "mujoco", "time_required");
  EXPECT_NEAR(metric(folder_ / "gazebo", "time_required"), embedded_s, 0.05 * embedded_s);
  EXPECT_THAT(std::string(read_result(folder_ / "gazebo")["versions"]["simulator"]),
              testing::StartsWith("Gazebo 11"));
  EXPECT_EQ(audit_code(folder_ / "gazebo"), 0);
}

INSTANTIATE_TEST_SUITE_P(All, ShippedScenario, testing::Values("face_anchor", "move_forward"));

// Gazebo gets a quarter of each core, and simulates slowly; nothing else changes by it.
TEST_F(GazeboFlight, DoesNotFeelALoadThatSlowsGazebo) {
  const auto scenario = write_shipped_scenario(folder_.path(), "face_anchor", {scripted_host(10)});
  const std::vector<std::string> options = {"--simulator", "gazebo", "--images"};
  fly(scenario, folder_ / "alone", options);
  {
    const std::vector<Spinner> load(2 * std::thread::hardware_concurrency());
    fly(scenario, folder_ / "loaded", options, {"nice", "-n", "5"});
  }
  expect_same_runs(folder_ / "alone", folder_ / "loaded");
  const double alone_s = read_result(folder_ / "alone")["this_run"]["wall_s"];
  EXPECT_GE(read_result(folder_ / "loaded")["this_run"]["wall_s"], 1.5 * alone_s);
}

}  // namespace
}  // namespace tether::system_test
