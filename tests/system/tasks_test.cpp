#include "support/trials.h"

#include <gtest/gtest.h>

/// Each of the paper's tasks as it is shipped: scenario, task, simulator, metrics, audit.
namespace tether::system_test {
namespace {

std::filesystem::path shipped(const std::string& scenario) {
  return std::filesystem::path(TETHER_SOURCE_DIR) / "scenarios" / (scenario + ".toml");
}

nlohmann::json fly(const TempFolder& folder, const std::string& scenario,
                   const std::string& condition) {
  const auto out = folder / (scenario + "-" + condition);
  const Output output = run(tether({"run", shipped(scenario), "--quiet", "--condition", condition,
                                    "--out", out.string()}),
                            std::chrono::seconds(100));
  EXPECT_LE(output.code, 1) << output.err;
  return read_result(out);
}

double value(const nlohmann::json& result, const std::string& metric) {
  for (const auto& one : result["metrics"])
    if (one["name"] == metric) return one["value"].get<double>();
  ADD_FAILURE() << "no metric " << metric;
  return -1.0;
}

class ShippedScenario : public testing::TestWithParam<const char*> {};

TEST_P(ShippedScenario, ReachesItsGoalOnTheHost) {
  const TempFolder folder;
  const auto result = fly(folder, GetParam(), "host");
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
  const auto tasks = fly(folder, "mission", "host")["suts"][0]["details"]["tasks"];
  ASSERT_EQ(tasks.size(), 3u);
  EXPECT_EQ(tasks[1]["task"], "face_anchor");
  for (const auto& task : tasks) EXPECT_EQ(task["status"], "reached") << task;
  EXPECT_LE(std::abs(tasks[2]["results"]["bearing_rad"].get<double>()), 0.07);
}

// What the paper's Table IV says, in one trial each.
TEST(MoveForward, ASlowComputerStopsFurtherFromTheAnchor) {
  const TempFolder folder;
  const auto host = fly(folder, "move_forward", "host");
  const auto target = fly(folder, "move_forward", "target");
  EXPECT_GT(value(target, "abeam_error"), 1.3 * value(host, "abeam_error"));
  EXPECT_LT(value(target, "time_required"), 1.15 * value(host, "time_required"));
}

}  // namespace
}  // namespace tether::system_test
