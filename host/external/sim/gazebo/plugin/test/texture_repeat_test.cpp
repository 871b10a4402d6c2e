#include <numbers>

#include <gtest/gtest.h>

#include <tether/sim_gazebo_plugin/shape_rays.h>

namespace tether::gazebo_plugin {
namespace {

constexpr uav::Vec3 kSize{2.0, 2.0, 5.0};

TEST(TextureRepeat, CountsMetresOfUnitShapesButNotOfMeshes) {
  const TextureRepeat cylinder = texture_repeat("unit_cylinder", kSize, 3.0, 0.5);
  EXPECT_DOUBLE_EQ(cylinder.x, 2.0 * std::numbers::pi * 3.0);
  EXPECT_DOUBLE_EQ(cylinder.y, 2.5);
  EXPECT_DOUBLE_EQ(texture_repeat("unit_sphere", kSize, 1.0, 2.0).y, 2.0 * std::numbers::pi);
  EXPECT_DOUBLE_EQ(texture_repeat("unit_plane", {4.0, 6.0, 1.0}, 0.5, 0.5).y, 3.0);
  EXPECT_EQ(texture_repeat("/models/chair.obj", kSize, 3.0, 3.0).x, 1.0);
}

}  // namespace
}  // namespace tether::gazebo_plugin
