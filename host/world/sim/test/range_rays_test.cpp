#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <tether/sim/bodies.h>

namespace tether::sim {
namespace {

constexpr uav::Vec3 kMiddle{1.0, 0.0, 0.0};

TEST(RangeRaysTest, BeginsWithTheMiddleRay) {
  EXPECT_EQ(cone_of_rays(0.0), std::vector{kMiddle});
  EXPECT_EQ(cone_of_rays(0.4).front(), kMiddle);
}

TEST(RangeRaysTest, UnitVectorsWithinTheConeAndUpToItsEdge) {
  for (const double angle_rad : {0.01, 0.47, std::numbers::pi}) {
    double widest_rad = 0.0;
    for (const uav::Vec3& ray : cone_of_rays(angle_rad)) {
      EXPECT_NEAR(uav::norm(ray), 1.0, 1e-12);
      widest_rad = std::max(widest_rad, std::atan2(std::hypot(ray.y, ray.z), ray.x));
    }
    EXPECT_NEAR(widest_rad, 0.5 * angle_rad, 1e-9);
  }
}

// Whatever lies in the cone has a ray within an eighth of the angle.
TEST(RangeRaysTest, NoLargerGapsThanPromised) {
  constexpr double kAngle = 0.5;
  const auto rays = cone_of_rays(kAngle);
  for (int i = 0; i < 400; ++i) {
    const double off = 0.5 * kAngle * std::sqrt((i + 0.5) / 400.0);
    const double around = 2.4 * i;
    const uav::Vec3 direction{std::cos(off), std::sin(off) * std::cos(around),
                              std::sin(off) * std::sin(around)};
    double nearest_rad = 1.0;
    for (const uav::Vec3& ray : rays) {
      nearest_rad = std::min(nearest_rad, std::acos(std::min(1.0, uav::dot(ray, direction))));
    }
    EXPECT_LT(nearest_rad, kAngle / 8.0);
  }
}

}  // namespace
}  // namespace tether::sim
