#include <limits>

#include <gtest/gtest.h>

#include <tether/sim_gazebo_plugin/shape_rays.h>

namespace tether::gazebo_plugin {
namespace {

constexpr double kNothing = std::numeric_limits<double>::infinity();

TEST(ShapeRays, MeetTheNearFaceOfABox) {
  EXPECT_DOUBLE_EQ(distance_to_box_m({{-3, 0.2, 0.3}, {1, 0, 0}}, {2, 1, 1}), 2.0);
  EXPECT_DOUBLE_EQ(distance_to_box_m({{0, 0, 5}, {0, 0, -1}}, {2, 1, 1}), 4.5);
}

TEST(ShapeRays, MissABoxBesideAndBehindThem) {
  EXPECT_EQ(distance_to_box_m({{-3, 0.6, 0}, {1, 0, 0}}, {2, 1, 1}), kNothing);
  EXPECT_EQ(distance_to_box_m({{3, 0, 0}, {1, 0, 0}}, {2, 1, 1}), kNothing);
}

TEST(ShapeRays, MeetTheFarSideFromWithin) {
  EXPECT_DOUBLE_EQ(distance_to_box_m({{0.5, 0, 0}, {1, 0, 0}}, {2, 1, 1}), 0.5);
  EXPECT_DOUBLE_EQ(distance_to_sphere_m({{0, 0, 0.5}, {0, 0, 1}}, 2.0), 1.5);
  EXPECT_DOUBLE_EQ(distance_to_cylinder_m({{0, 0, 0}, {0, 1, 0}}, 0.5, 2.0), 0.5);
}

TEST(ShapeRays, MeetASphere) {
  EXPECT_DOUBLE_EQ(distance_to_sphere_m({{0, -5, 0}, {0, 1, 0}}, 2.0), 3.0);
  EXPECT_EQ(distance_to_sphere_m({{2.1, -5, 0}, {0, 1, 0}}, 2.0), kNothing);
}

TEST(ShapeRays, MeetACylinderAtItsSide) {
  EXPECT_DOUBLE_EQ(distance_to_cylinder_m({{-3, 0, 0.9}, {1, 0, 0}}, 0.5, 2.0), 2.5);
  EXPECT_EQ(distance_to_cylinder_m({{-3, 0, 1.1}, {1, 0, 0}}, 0.5, 2.0), kNothing);
  EXPECT_EQ(distance_to_cylinder_m({{-3, 0.6, 0}, {1, 0, 0}}, 0.5, 2.0), kNothing);
}

TEST(ShapeRays, MeetACylinderAtItsEnds) {
  EXPECT_DOUBLE_EQ(distance_to_cylinder_m({{0.3, 0, 4}, {0, 0, -1}}, 0.5, 2.0), 3.0);
  EXPECT_EQ(distance_to_cylinder_m({{0.6, 0, 4}, {0, 0, -1}}, 0.5, 2.0), kNothing);
}

}  // namespace
}  // namespace tether::gazebo_plugin
