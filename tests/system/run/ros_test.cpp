#include "support/trials.h"

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

/// Nodes of ROS 1 fly as they are, if ROS is installed.
namespace tether::system_test {
namespace {

const std::string kFlight = TETHER_SOURCE_DIR "/examples/ros1-face-box/face_box.toml";

class Ros1 : public testing::Test {
 protected:
  void SetUp() override {
    const char* const needed = "import cv2, cv_bridge, geometry_msgs.msg, roslaunch, rospy";
    if (run({{"/usr/bin/python3", "-c", needed}}).code != 0)
      GTEST_SKIP() << "needs Debian's python3-roslaunch, python3-cv-bridge and python3-opencv";
  }
  Output fly(const std::string& condition) const {
    return run(tether({"run", kFlight, "--quiet", "--force", "--condition", condition, "--out",
                       folder_ / "out"}));
  }
  std::string said() const { return read_text(folder_ / "out" / "sut-uav1.log"); }
  /// From an image to its command, each as the tracker says: "… 29.87 ms".
  std::vector<double> latencies_ms() const {
    std::vector<double> all;
    std::istringstream lines(said());
    for (std::string line; std::getline(lines, line);)
      if (line.ends_with(" ms"))
        all.push_back(std::stod(line.substr(line.rfind(' ', line.size() - 4))));
    std::ranges::sort(all);
    return all;
  }

  TempFolder folder_;
};

TEST_F(Ros1, NodesFaceABoxAndOnASlowComputerTheyDoNot) {
  const Output fast = fly("host");
  EXPECT_EQ(fast.code, 0) << fast.err << said();
  EXPECT_EQ(audit_code(folder_ / "out"), 0);
  const std::vector<double> on_fast = latencies_ms();
  ASSERT_GT(on_fast.size(), 20U) << said();
  const Output slow = fly("target");
  EXPECT_EQ(slow.code, 1) << slow.err << said();
  EXPECT_EQ(audit_code(folder_ / "out"), 0);
  const std::vector<double> on_slow = latencies_ms();
  ASSERT_GT(on_slow.size(), 10U) << said();
  // The slow computer also waits for images that queue up.
  EXPECT_GT(on_slow[on_slow.size() / 2], 5.0 * on_fast[on_fast.size() / 2]);
}

}  // namespace
}  // namespace tether::system_test
