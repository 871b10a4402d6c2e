#include "fake_vehicle.h"

#include <gmock/gmock.h>

namespace tether::c_api {
namespace {

// cpp_api_test has the rest, through the C++ API.
TEST(Sensors, HaveTheirPropertiesAndNoOthers) {
  const Flown flown;
  const auto* camera = tether_find_sensor(flown.vehicle, "camera");
  EXPECT_EQ(camera, tether_sensor_at(flown.vehicle, 0));
  EXPECT_EQ(tether_sensor_get_kind(tether_sensor_at(flown.vehicle, 1)), TETHER_IMU);
  tether_pose X_BS;
  ASSERT_EQ(tether_sensor_mounting(camera, &X_BS), TETHER_OK);
  EXPECT_EQ(X_BS.attitude.y, -0.5);
  tether_camera_model model;
  ASSERT_EQ(tether_sensor_camera_model(camera, &model, sizeof model), TETHER_OK);
  EXPECT_EQ(model.cx_px, 1.5);
  EXPECT_EQ(model.k2, 0.2);
  EXPECT_EQ(model.k3, 0.3);
  EXPECT_EQ(model.p1, 0.4);
  EXPECT_EQ(model.p2, 0.5);
  const auto* range = tether_find_sensor(flown.vehicle, "down");
  double min_m = 0.0, max_m = 0.0;
  ASSERT_EQ(tether_sensor_range_limits(range, &min_m, &max_m), TETHER_OK);
  EXPECT_EQ(min_m, 0.1);
  EXPECT_EQ(tether_sensor_camera_model(range, &model, sizeof model), TETHER_INVALID);
  EXPECT_EQ(model.width_px, 0);
  EXPECT_EQ(tether_sensor_range_limits(camera, &min_m, &max_m), TETHER_INVALID);
  EXPECT_EQ(max_m, 0.0);
}

TEST(Sensors, OtherCamerasHaveKindsOfTheirOwn) {
  const Flown flown;
  const auto* rgbd = tether_find_sensor(flown.vehicle, "rgbd");
  const auto* labels = tether_find_sensor(flown.vehicle, "labels");
  EXPECT_EQ(tether_sensor_get_kind(rgbd), TETHER_RGBD_CAMERA);
  EXPECT_EQ(tether_sensor_get_kind(labels), TETHER_SEGMENTATION_CAMERA);
  tether_camera_model model;
  EXPECT_EQ(tether_sensor_camera_model(labels, &model, sizeof model), TETHER_OK);
  double min_m = 0.0, max_m = 0.0;
  ASSERT_EQ(tether_sensor_range_limits(rgbd, &min_m, &max_m), TETHER_OK);
  EXPECT_EQ(max_m, 9.0);
  EXPECT_EQ(tether_sensor_range_limits(labels, &min_m, &max_m), TETHER_INVALID);
  EXPECT_STREQ(tether_sensor_label_model(labels, 2), "blue_box");
  for (const std::uint16_t none : std::initializer_list<std::uint16_t>{0, 3, 65535})
    EXPECT_EQ(tether_sensor_label_model(labels, none), nullptr);
  EXPECT_EQ(tether_sensor_label_model(rgbd, 1), nullptr);
  EXPECT_EQ(tether_sensor_label_model(nullptr, 1), nullptr);
}

TEST(Catalogue, HasNothingBeyondItsEnd) {
  const Flown flown;
  EXPECT_EQ(tether_sensor_at(flown.vehicle, 12), nullptr);
  EXPECT_EQ(tether_anchor_get_shape(tether_anchor_at(flown.vehicle, 1)), TETHER_SPHERE);
  EXPECT_EQ(tether_anchor_at(flown.vehicle, 2), nullptr);
  EXPECT_EQ(tether_find_anchor(flown.vehicle, ""), nullptr);
}

TEST(Catalogue, AcceptsNull) {
  EXPECT_STREQ(tether_uav_name(nullptr), "");
  EXPECT_EQ(tether_sensor_count(nullptr), 0u);
  EXPECT_EQ(tether_sensor_at(nullptr, 0), nullptr);
  EXPECT_EQ(tether_find_sensor(nullptr, "camera"), nullptr);
  EXPECT_STREQ(tether_sensor_name(nullptr), "");
  EXPECT_EQ(tether_sensor_get_kind(nullptr), -1);
  EXPECT_EQ(tether_anchor_at(nullptr, 0), nullptr);
  EXPECT_EQ(tether_anchor_get_shape(nullptr), -1);
  tether_vec3 out{1, 1, 1};
  EXPECT_EQ(tether_anchor_color(nullptr, &out), TETHER_INVALID);
  EXPECT_EQ(out.x, 0.0);
  EXPECT_EQ(tether_anchor_size(nullptr, nullptr), TETHER_INVALID);
}

}  // namespace
}  // namespace tether::c_api
