#include <cmath>

#include <gtest/gtest.h>

#include <tether/base/units.h>

namespace tether {
namespace {

TEST(Units, DegreesAndRadians) {
  EXPECT_DOUBLE_EQ(rad_from_deg(180.0), std::numbers::pi);
  EXPECT_DOUBLE_EQ(deg_from_rad(std::numbers::pi / 2), 90.0);
}

TEST(Units, WrapsIntoHalfOpenInterval) {
  constexpr double pi = std::numbers::pi;
  EXPECT_DOUBLE_EQ(wrap_angle_rad(pi), pi);
  EXPECT_DOUBLE_EQ(wrap_angle_rad(-pi), pi);
  EXPECT_NEAR(wrap_angle_rad(3 * pi + 0.1), -pi + 0.1, 1e-12);
  for (double a = -50.0; a < 50.0; a += 0.37) {
    const double w = wrap_angle_rad(a);
    EXPECT_GT(w, -pi);
    EXPECT_LE(w, pi);
    EXPECT_NEAR(std::remainder(a - w, 2 * pi), 0.0, 1e-12);
  }
}

}  // namespace
}  // namespace tether
