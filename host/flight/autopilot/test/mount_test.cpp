#include "mount.h"

#include <limits>

#include <gtest/gtest.h>

namespace tether::autopilot {
namespace {

constexpr double kKeep = std::numeric_limits<double>::quiet_NaN();
constexpr double kNinety_rad = 1.5707963267948966;

// Yaw about up, pitch about right (against the body's left), roll about ahead.
const std::vector<uav::Joint> kGimbal = {{"yaw", {}, {0, 0.1, 1}, -3, 3, 1},
                                         {"pitch", {}, {0, -1, 0}, -1, 2, 1},
                                         {"roll", {}, {1, 0, 0}, -1, 1, 1}};

std::vector<double> pointed(const MountAngles& wanted, bool turns = true) {
  std::vector<double> angles_rad = {0.1, 0.2, 0.3};
  EXPECT_EQ(point(kGimbal, wanted, angles_rad), turns);
  return angles_rad;
}

TEST(Mount, TurnsEachJointAboutTheAxisThatIsNearest) {
  EXPECT_EQ(pointed({kKeep, kKeep, 90}), (std::vector{-kNinety_rad, 0.2, 0.3})) << "to the right";
  EXPECT_EQ(pointed({90, kKeep, kKeep}), (std::vector{0.1, kNinety_rad, 0.3})) << "up";
  EXPECT_EQ(pointed({-90, 90, 0}), (std::vector{-0.0, -1.0, 1.0})) << "within their limits";
  EXPECT_EQ(pointed({kKeep, kKeep, kKeep}, false), (std::vector{0.1, 0.2, 0.3}));
}

TEST(Mount, NeedsAJointForWhatItIsAsked) {
  std::vector<double> angle_rad = {0.1};
  EXPECT_FALSE(point(std::span(kGimbal).first(1), {-45, kKeep, kKeep}, angle_rad));
  EXPECT_EQ(angle_rad[0], 0.1);
  EXPECT_TRUE(point(std::span(kGimbal).first(1), {-45, 0, 0}, angle_rad)) << "its yaw at least";
  EXPECT_EQ(angle_rad[0], 0.0);
}

}  // namespace
}  // namespace tether::autopilot
