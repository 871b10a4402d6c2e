#include "test_scenes.h"

#include <gtest/gtest.h>

#include <tether/sim_raster/renderer.h>

namespace tether::raster {
namespace {

using uav::Pose;
using uav::Vec3;

// A camera in the first place and a body in the second, at each instant.
struct Course {
  explicit Course(const std::vector<std::array<Pose, 2>>& of_both) {
    for (const auto& both : of_both) bodies.push_back(both[1]);
    for (std::size_t i = 0; i < of_both.size(); ++i) {
      instants.push_back({of_both[i][0], {bodies.data() + i, 1}});
    }
    view.camera.fx_px = view.camera.fy_px = 500.0;
    view.instants = instants;
    view.spacing_s = 0.001;
    view.exposure_s = 0.001 * static_cast<double>(of_both.size() - 1);
  }
  std::vector<Pose> bodies;
  std::vector<Instant> instants;
  View view;
};

Pose at(double x) {
  return {{x, 0.0, 0.0}, {}};
}
Pose turned(const Vec3& axis, double angle_rad) {
  return {{}, uav::from_axis_angle(axis, angle_rad)};
}

TEST(View, IsInterpolatedBetweenItsInstants) {
  const Course course({{at(0.0), at(5.0)}, {at(1.0), at(5.0)}, {at(3.0), at(9.0)}});
  Moment moment;
  for (const auto& [before_end_s, camera, body] : {std::array{0.0, 3.0, 9.0},
                                                   {0.0005, 2.0, 7.0},
                                                   {0.001, 1.0, 5.0},
                                                   {0.00175, 0.25, 5.0},
                                                   {0.002, 0.0, 5.0},
                                                   {1.0, 0.0, 5.0}}) {
    interpolate(course.view, before_end_s, moment);
    EXPECT_NEAR(moment.X_WC.p.x, camera, 1e-12) << before_end_s;
    EXPECT_NEAR(moment.X_WB.at(0).p.x, body, 1e-12) << before_end_s;
  }
}

TEST(View, MovesByCameraAndBodies) {
  struct Case {
    const char* what;
    std::array<Pose, 2> before, after;
    double radius_m, nearest_m, motion_px;
  };
  const Pose there{{0.0, 0.0, 2.5}, {}};
  for (const Case& c : std::vector<Case>{
           {"at rest", {at(1.0), there}, {at(1.0), there}, 9.0, 0.1, 0.0},
           {"turning moves all alike",
            {at(0.0), there},
            {turned({0.0, 0.6, 0.8}, 0.01), there},
            0.5,
            0.1,
            5.0},
           {"the other way, far away",
            {at(0.0), there},
            {turned({0.0, 0.6, 0.8}, -0.01), there},
            0.5,
            99.0,
            5.0},
           {"shifting", {at(0.0), there}, {at(0.02), there}, 0.5, 2.0, 5.0},
           {"shifting moves near things more", {at(0.0), there}, {at(0.02), there}, 0.5, 0.5, 20.0},
           {"a body's nearest point",
            {at(0.0), {{0.02, 0.0, 2.5}, {}}},
            {at(0.0), there},
            0.5,
            9.0,
            5.0},
           {"no nearer than the near plane",
            {at(0.0), {{0.02, 0.0, 2.5}, {}}},
            {at(0.0), there},
            5.0,
            9.0,
            200.0},
           {"a body that turns",
            {at(0.0), there * turned({0.0, 0.0, 1.0}, 0.1)},
            {at(0.0), there},
            0.5,
            9.0,
            12.5}}) {
    const Course course({c.before, c.after});
    EXPECT_NEAR(motion_px(course.view, std::array{c.radius_m}, c.nearest_m), c.motion_px,
                1e-3 * c.motion_px)
        << c.what;
    Course hidden = course;
    hidden.view.hidden = 0;
    if (c.before[0] == c.after[0]) {
      EXPECT_EQ(motion_px(hidden.view, std::array{c.radius_m}, c.nearest_m), 0.0) << c.what;
    }
  }
}

TEST(View, MovesThroughoutAsInItsFastestStep) {
  Course course({{at(0.0), at(9.0)}, {at(0.0), at(9.0)}, {at(0.02), at(9.0)}});
  EXPECT_NEAR(motion_px(course.view, std::array{0.0}, 2.0), 2 * 5.0, 1e-9);
  course.view.exposure_s = 0.0005;
  course.view.readout_s = 0.001;
  EXPECT_NEAR(motion_px(course.view, std::array{0.0}, 2.0), 1.5 * 5.0, 1e-9);
}

}  // namespace
}  // namespace tether::raster
