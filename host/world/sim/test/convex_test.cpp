#include "convex.h"

#include <cmath>

#include <gtest/gtest.h>

#include <tether/base/random.h>

namespace tether::sim {
namespace {

using uav::Pose;
using uav::Vec3;

const BoxGeometry kBox{{2.0, 2.0, 2.0}};
const CylinderGeometry kCylinder{1.0, 2.0};

struct DistanceCase {
  std::string name;
  Geometry a, b;
  Pose X_WB;
  double distance_m;
};

class ConvexDistanceTest : public ::testing::TestWithParam<DistanceCase> {};

TEST_P(ConvexDistanceTest, IsThatOfTheNearestPoints) {
  const DistanceCase& c = GetParam();
  const Convex a{c.a, {}, {}}, b{c.b, {}, c.X_WB};
  EXPECT_NEAR(distance_m(a, b), c.distance_m, 1e-5);
  EXPECT_NEAR(distance_m(b, a), c.distance_m, 1e-5);
}

const uav::Quat kTurned = uav::from_rpy(0.0, 0.0, std::atan(1.0));
const std::vector<DistanceCase> kDistanceCases = {
    {"Faces", kBox, kBox, {{3.0, 0.5, 0.3}, {}}, 1.0},
    {"Corners", kBox, kBox, {{3.0, 3.0, 3.0}, {}}, std::sqrt(3.0)},
    {"EdgeToFace", kBox, kBox, {{4.0, 0.0, 0.0}, kTurned}, 3.0 - std::sqrt(2.0)},
    {"Inside", kBox, SphereGeometry{0.1}, {{0.2, 0.3, 0.4}, {}}, 0.0},
    {"AtOneCentre", kBox, kBox, {}, 0.0},
    {"Overlapping", kBox, kCylinder, {{1.5, 0.2, 0.0}, {}}, 0.0},
    {"Spheres", SphereGeometry{0.5}, SphereGeometry{0.7}, {{0.0, 3.0, 4.0}, {}}, 3.8},
    {"Capsule", kBox, CapsuleGeometry{0.25, 1.0}, {{0.0, 0.0, 3.0}, {}}, 1.25},
    {"CylinderRimToFace", kBox, kCylinder, {{0.0, 4.0, 0.0}, {}}, 2.0},
    {"CylinderAboveFloor", BoxGeometry{{20.0, 20.0, 2.0}}, kCylinder, {{3.0, 3.0, 2.5}, {}}, 0.5},
    {"Ellipsoid", kBox, EllipsoidGeometry{{2.0, 1.0, 0.5}}, {{4.0, 0.0, 0.0}, {}}, 1.0},
};

INSTANTIATE_TEST_SUITE_P(Shapes, ConvexDistanceTest, ::testing::ValuesIn(kDistanceCases),
                         [](const auto& named) { return named.param.name; });

// Against points of the shapes: none is nearer, and far along the way between the shapes they are
// as near as said (a support plane separates them by that much).
TEST(ConvexDistance, OfRandomShapesIsWithinTheBoundsOfTheirPoints) {
  KeyedRandom random({5, 1, 0});
  const auto number = [&](double low, double high) {
    return low + (high - low) * random.uniform();
  };
  const auto geometry = [&]() -> Geometry {
    const double a = number(0.05, 2.0), b = number(0.05, 2.0), c = number(0.05, 2.0);
    const Geometry kinds[] = {BoxGeometry{{a, b, c}}, CylinderGeometry{a, b}, SphereGeometry{a},
                              CapsuleGeometry{a, b}, EllipsoidGeometry{{a, b, c}}};
    return kinds[random.bits() % 5];
  };
  const auto pose = [&]() -> Pose {
    return {{number(-4, 4), number(-4, 4), number(-4, 4)},
            uav::from_rpy(number(-3, 3), number(-1, 1), number(-3, 3))};
  };
  for (int i = 0; i < 300; ++i) {
    const Geometry geometry_a = geometry(), geometry_b = geometry();
    const Convex a{geometry_a, {}, pose()}, b{geometry_b, {}, pose()};
    const double measured_m = distance_m(a, b);
    const double rounding = rounding_m(a) + rounding_m(b);
    double separation_m = 0.0;  // the widest gap between two parallel planes
    double nearest_m = 1e9;     // between points of both
    for (int k = 0; k < 2000; ++k) {
      const Vec3 v{number(-1, 1), number(-1, 1), number(-1, 1)};
      const Vec3 n = (1.0 / norm(v)) * v;
      const Vec3 gap = support_point(b, -1.0 * n) - support_point(a, n);
      separation_m = std::max(separation_m, dot(gap, n) - rounding);
      nearest_m = std::min(nearest_m, norm(gap) - rounding);
    }
    EXPECT_GE(measured_m, separation_m - 1e-5) << i;
    EXPECT_LE(measured_m, std::max(0.0, nearest_m) + 1e-5) << i;
    EXPECT_LE(measured_m, std::max(0.0, separation_m) * 1.05 + 0.05) << i;
  }
}

}  // namespace
}  // namespace tether::sim
