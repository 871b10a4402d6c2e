#include "support/trials.h"

#include <gtest/gtest.h>

/// Each of the paper's tasks as it is shipped: scenario, task, simulator, metrics, audit.
namespace tether::system_test {
namespace {

std::filesystem::path shipped(const std::string& scenario) {
  return std::filesystem::path(TETHER_SOURCE_DIR) / "scenarios" / (scenario + ".toml");
}

nlohmann::json fly(const TempFolder& folder, const std::string& scenario) {
  const auto out = folder / scenario;
  const Output output = run(
      tether({"run", shipped(scenario), "--quiet", "--condition", "host", "--out", out.string()}),
      std::chrono::seconds(100));
  EXPECT_EQ(output.code, 0) << output.err;
  return read_result(out);
}

class ShippedScenario : public testing::TestWithParam<const char*> {};

TEST_P(ShippedScenario, ReachesItsGoalOnTheHost) {
  const TempFolder folder;
  const auto result = fly(folder, GetParam());
  EXPECT_EQ(result["outcome"], "goal_reached") << result["reason"];
  EXPECT_TRUE(result["audit"]["passed"]) << result["audit"]["summary"];
  for (const auto& metric : result["metrics"]) EXPECT_TRUE(metric["value"].is_number()) << metric;
  const auto& details = result["suts"][0]["details"];
  EXPECT_EQ(details["status"], "reached") << details;
}

INSTANTIATE_TEST_SUITE_P(Tasks, ShippedScenario,
                         testing::Values("sensor_characterization", "relative_position",
                                         "face_anchor", "move_forward", "closed_path", "mission"),
                         [](const auto& one) { return std::string(one.param); });

TEST(Missions, EachTasksOutcomeLandsInTheResult) {
  const TempFolder folder;
  const auto tasks = fly(folder, "mission")["suts"][0]["details"]["tasks"];
  ASSERT_EQ(tasks.size(), 3u);
  EXPECT_EQ(tasks[1]["task"], "face_anchor");
  for (const auto& task : tasks) EXPECT_EQ(task["status"], "reached") << task;
  EXPECT_LE(std::abs(tasks[2]["results"]["bearing_rad"].get<double>()), 0.07);
}

// What the paper's Table IV says, on a target far slower still, so that one trial is enough.
TEST(MoveForward, AComputerThatIsTooSlowMissesItsGoal) {
  const TempFolder folder;
  const std::string sources = std::filesystem::path(TETHER_SOURCE_DIR).string();
  std::string text = substituted(read_text(shipped("move_forward")),
                                 {{"cpu_factor = 6.0", "cpu_factor = 10.0"},
                                  {"\"../worlds", "\"" + sources + "/worlds"},
                                  {"\"../models", "\"" + sources + "/models"}});
  write_text(folder / "slow.toml", text);
  const Output output = run(tether({"run", (folder / "slow.toml").string(), "--quiet",
                                    "--condition", "target", "--out", (folder / "out").string()}),
                            std::chrono::seconds(100));
  EXPECT_EQ(output.code, 1) << output.err;
  const auto result = read_result(folder / "out");
  EXPECT_EQ(result["outcome"], "goal_missed");
  EXPECT_TRUE(result["audit"]["passed"]) << result["audit"]["summary"];
}

}  // namespace
}  // namespace tether::system_test
