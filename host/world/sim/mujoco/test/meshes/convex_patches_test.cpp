#include "meshes/convex_patches.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::sim {
namespace {

using uav::Vec3;

void add_quad(Surface& surface, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  surface.push_back({a, b, c});
  surface.push_back({a, c, d});
}

/// A wall of 4 m × 3 m in the plane of x and z, with a door of 1 m × 2 m.
Surface wall_with_door() {
  Surface wall;
  const auto cell = [&](double x0, double x1, double z0, double z1) {
    add_quad(wall, {x0, 0, z0}, {x1, 0, z0}, {x1, 0, z1}, {x0, 0, z1});
  };
  const double x[] = {0.0, 1.5, 2.5, 4.0}, z[] = {0.0, 2.0, 3.0};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 2; ++k)
      if (i != 1 || k != 0) cell(x[i], x[i + 1], z[k], z[k + 1]);
  return wall;
}

/// A sphere of radius 1 m.
Surface sphere(int rings) {
  Surface surface;
  const auto at = [&](int i, int k) {
    const double t = std::numbers::pi * i / rings, f = std::numbers::pi * (k % (2 * rings)) / rings;
    return Vec3{std::sin(t) * std::cos(f), std::sin(t) * std::sin(f), std::cos(t)};
  };
  const Vec3 top{0, 0, 1}, bottom{0, 0, -1};
  for (int k = 0; k < 2 * rings; ++k) {
    surface.push_back({top, at(1, k), at(1, k + 1)});
    for (int i = 1; i + 1 < rings; ++i)
      add_quad(surface, at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1));
    surface.push_back({at(rings - 1, k + 1), at(rings - 1, k), bottom});
  }
  return surface;
}

bool covers(const std::vector<Vec3>& patch, double x, double z) {
  double low_x = 1e9, high_x = -1e9, low_z = 1e9, high_z = -1e9;
  for (const Vec3& p : patch) {
    low_x = std::min(low_x, p.x), high_x = std::max(high_x, p.x);
    low_z = std::min(low_z, p.z), high_z = std::max(high_z, p.z);
  }
  return low_x < x && x < high_x && low_z < z && z < high_z;
}

TEST(ConvexPatches, LeaveADoorOpen) {
  ConvexPatches wall(wall_with_door());
  wall.join(0.01);
  EXPECT_EQ(wall.size(), 3U);
  for (const auto& patch : wall.points()) {
    EXPECT_FALSE(covers(patch, 2.0, 1.0)) << "the door";
    EXPECT_EQ(patch.size(), 8U) << "each is a rectangle, with two sides";
  }
}

TEST(ConvexPatches, OfACurveAreWithinTheirToleranceOfIt) {
  ConvexPatches patches(sphere(24));
  std::size_t before = patches.size();
  for (const double tolerance_m : {0.01, 0.04, 0.16}) {
    patches.join(tolerance_m);
    EXPECT_LT(patches.size(), before) << tolerance_m;
    before = patches.size();
    for (const auto& patch : patches.points()) {
      Vec3 middle{};
      for (const Vec3& p : patch) middle = middle + (1.0 / static_cast<double>(patch.size())) * p;
      EXPECT_NEAR(norm(middle), 1.0, tolerance_m + 0.005) << "the sphere itself has facets of 4 mm";
    }
  }
}

TEST(ConvexPatches, AreOfNeighboursOnly) {
  Surface far = wall_with_door();
  add_quad(far, {100, 0, 0}, {101, 0, 0}, {101, 0, 1}, {100, 0, 1});
  ConvexPatches patches(far);
  patches.join(1.0);
  for (const auto& patch : patches.points()) EXPECT_FALSE(covers(patch, 50.0, 0.5));
}

TEST(ConvexPatches, OfOneSurfaceAreTheSameWhateverTheOrderOfItsTriangles) {
  Surface surface = wall_with_door();
  ConvexPatches first(surface);
  first.join(0.01);
  std::mt19937 order(1);
  std::shuffle(surface.begin(), surface.end(), order);
  ConvexPatches second(surface);
  second.join(0.01);
  EXPECT_EQ(first.size(), second.size());
}

TEST(ConvexSolid, IsClosedConvexAndNotInsideOut) {
  Surface ball = sphere(8);
  EXPECT_TRUE(is_convex_solid(ball));
  EXPECT_NEAR(signed_volume_m3(ball), 4.0 / 3.0 * std::numbers::pi, 0.3);
  for (Triangle& t : ball) std::swap(t[0], t[1]);
  EXPECT_FALSE(is_convex_solid(ball)) << "inside out";
  EXPECT_LT(signed_volume_m3(ball), 0.0);
  ball = sphere(8);
  ball.pop_back();
  EXPECT_FALSE(is_convex_solid(ball)) << "open";
  ball = sphere(8);
  for (Triangle& t : ball)
    for (Vec3& p : t)
      if (p.z == 1.0) p.z = 0.0;
  EXPECT_FALSE(is_convex_solid(ball)) << "with a dent";
}

}  // namespace
}  // namespace tether::sim
