#include "support/gzserver.h"
#include "support/trials.h"

#include <algorithm>
#include <cmath>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

/// Real flights in a real Gazebo: the same world, the same UAV, the same rules of time as in the
/// embedded simulator.
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;

constexpr auto kLimit = 240s;

/// What a flight under the scenario's condition "host" left in `out`.
void fly(const std::filesystem::path& scenario, const std::filesystem::path& out,
         const std::vector<std::string>& options, const std::vector<std::string>& launcher = {}) {
  Command command = tether({"run", scenario, "--condition", "host", "--quiet", "--out", out});
  command.arguments.insert(command.arguments.end(), options.begin(), options.end());
  command.arguments.insert(command.arguments.begin(), launcher.begin(), launcher.end());
  Process process(command);
  const Output output = process.wait(kLimit);
  ASSERT_EQ(output.code, 0) << output.err;
}

double metric(const std::filesystem::path& out, const std::string& name) {
  const auto result = read_result(out);
  for (const auto& entry : result["metrics"])
    if (entry["name"] == name) return entry["value"];
  ADD_FAILURE() << "no metric " << name;
  return std::nan("");
}

/// Edges of the blue box in an image, those of the outermost pixels that nothing else has the
/// colour of.
struct Roi {
  int left, right, top, bottom;
};

Roi blue_roi(const record::Image& file) {
  const cv::Mat image = cv::imdecode(file.png, cv::IMREAD_COLOR);
  Roi roi{image.cols, -1, image.rows, -1};
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const auto& bgr = image.at<cv::Vec3b>(y, x);
      if (bgr[0] < 60 || bgr[0] < 2 * bgr[1] || bgr[0] < 3 * bgr[2]) continue;
      roi = {std::min(roi.left, x), std::max(roi.right, x), std::min(roi.top, y),
             std::max(roi.bottom, y)};
    }
  }
  return roi;
}

void expect_same_roi(const Roi& a, const Roi& b, int tolerance_px) {
  ASSERT_GE(a.right, 0) << "no anchor in the embedded simulator's image";
  ASSERT_GE(b.right, 0) << "no anchor in Gazebo's image";
  EXPECT_NEAR(a.left, b.left, tolerance_px);
  EXPECT_NEAR(a.right, b.right, tolerance_px);
  EXPECT_NEAR(a.top, b.top, tolerance_px);
  EXPECT_NEAR(a.bottom, b.bottom, tolerance_px);
}

class GazeboFlight : public testing::Test {
 protected:
  void SetUp() override {
    if (const auto why = no_gzserver()) GTEST_SKIP() << *why;
  }
  TempFolder folder_;
};

class ShippedScenario : public GazeboFlight, public testing::WithParamInterface<const char*> {};

// The start pose: the first image that the SUT has.
TEST_P(ShippedScenario, ShowsTheAnchorAtTheSamePlace) {
  const auto scenario = write_shipped_scenario(folder_.path(), GetParam(), {scripted_host(10)});
  for (const char* simulator : {"mujoco", "gazebo"})
    fly(scenario, folder_ / simulator, {"--simulator", simulator, "--images"});
  const auto embedded = read_record(folder_ / "mujoco"), gazebo = read_record(folder_ / "gazebo");
  ASSERT_FALSE(embedded.images.empty());
  ASSERT_FALSE(gazebo.images.empty());
  EXPECT_EQ(embedded.images.front().message.at, gazebo.images.front().message.at);
  expect_same_roi(blue_roi(embedded.images.front().message),
                  blue_roi(gazebo.images.front().message), 3);
}

TEST_P(ShippedScenario, TakesAsLongAsInTheEmbeddedSimulator) {
  const auto scenario = write_shipped_scenario(folder_.path(), GetParam(), {scripted_host(10)});
  for (const char* simulator : {"mujoco", "gazebo"})
    fly(scenario, folder_ / simulator, {"--simulator", simulator});
  const double embedded_s = metric(folder_ / "mujoco", "time_required");
  EXPECT_NEAR(metric(folder_ / "gazebo", "time_required"), embedded_s, 0.05 * embedded_s);
  EXPECT_THAT(std::string(read_result(folder_ / "gazebo")["versions"]["simulator"]),
              testing::StartsWith("Gazebo 11"));
  const Output audit = run(tether({"audit", folder_ / "gazebo/record.mcap"}));
  EXPECT_EQ(audit.code, 0) << audit.out;
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
  EXPECT_EQ(timeless_result(folder_ / "alone"), timeless_result(folder_ / "loaded"));
  EXPECT_TRUE(timeless_record(folder_ / "alone") == timeless_record(folder_ / "loaded"))
      << "the records differ";
  const double alone_s = read_result(folder_ / "alone")["this_run"]["wall_s"];
  EXPECT_GE(read_result(folder_ / "loaded")["this_run"]["wall_s"], 1.5 * alone_s);
}

}  // namespace
}  // namespace tether::system_test
