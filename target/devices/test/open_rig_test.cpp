#include "video_file.h"

#include <gmock/gmock.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/devices/rig.h>

namespace tether::devices {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class OpenRigTest : public testing::Test {
 protected:
  OpenRigTest() {
    write_video(scratch_.path("a.avi"), {{0, 0, 250}, {250, 0, 0}});
    scratch_.write("range/in_distance_raw", "731\n");
    scratch_.write("range/in_distance_scale", "0.001\n");
    for (const char* axis : {"x", "y", "z"}) {
      scratch_.write(std::string("accel/in_accel_") + axis + "_input", "1\n");
      scratch_.write(std::string("gyro/in_anglvel_") + axis + "_input", "2\n");
    }
  }
  RigSensor camera() const {
    return {{"front", {}, 0.0, uav::CameraProperties{}}, scratch_.path("a.avi")};
  }
  RigSensor range() const {
    return {{"down", {}, 0.0, uav::RangeProperties{0.0, 2.0}}, scratch_.path("range")};
  }
  RigSensor imu() const {
    return {{"imu", {}, 0.0, uav::ImuProperties{}},
            scratch_.path("accel").string() + "," + scratch_.path("gyro").string()};
  }

  ScratchFolder scratch_;
};

TEST_F(OpenRigTest, OpensEveryDevice) {
  const uav::Anchor anchor{"post", uav::AnchorShape::kBox, {1, 1, 1}, {1, 0, 0}};
  auto vehicle = open_rig({"bench", {camera(), range(), imu()}, {anchor}});
  ASSERT_TRUE(vehicle) << vehicle.failure().message;
  const uav::Catalogue& catalogue = (*vehicle)->catalogue();
  EXPECT_EQ(catalogue.uav, "bench");
  ASSERT_EQ(catalogue.sensors.size(), 3u);
  EXPECT_NEAR(catalogue.sensors[0].rate_hz, 25.0, 1e-3);
  EXPECT_NE(catalogue.find_anchor("post"), nullptr);

  const auto image = (*vehicle)->read<uav::CameraSample>("front");
  ASSERT_TRUE(image);
  EXPECT_EQ(image->width_px, 64);
  EXPECT_GE(image->sampled_at, SimTime{});
  EXPECT_LE(image->sampled_at, same_instant((*vehicle)->now()));
  EXPECT_DOUBLE_EQ((*vehicle)->read<uav::RangeSample>("down")->range_m, 0.731);
  const auto inertial = (*vehicle)->read<uav::ImuSample>("imu");
  ASSERT_TRUE(inertial);
  EXPECT_EQ(inertial->specific_force_m_s2, (uav::Vec3{1, 1, 1}));
  EXPECT_EQ(inertial->angular_velocity_rad_s, (uav::Vec3{2, 2, 2}));
}

TEST_F(OpenRigTest, FailureOfOneDeviceNamesIt) {
  RigSensor no_camera = camera(), no_imu = imu(), no_range = range();
  no_range.description.name = "other";
  no_camera.device = "/dev/null";
  no_imu.device = "iio:no-such-sensor";
  no_range.device = scratch_.path("nothing");
  for (const auto& [sensor, label] :
       {std::pair(no_camera, "camera /dev/null: "), std::pair(no_imu, "IMU iio:no-such-sensor: "),
        std::pair(no_range, "rangefinder /")}) {
    const auto none = open_rig({"bench", {range(), sensor}, {}});
    ASSERT_FALSE(none);
    EXPECT_EQ(none.failure().kind, Failure::Kind::kInvalid);
    EXPECT_THAT(none.failure().message, StartsWith(label));
  }
}

TEST_F(OpenRigTest, SensorNamesAreUnique) {
  RigSensor second = range();
  second.description.name = "front";
  const auto none = open_rig({"bench", {camera(), second}, {}});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.failure().kind, Failure::Kind::kInvalid);
  EXPECT_THAT(none.failure().message, HasSubstr("\"front\""));
  EXPECT_TRUE(open_rig({"bench", {}, {}})) << "a rig can be empty";
}

}  // namespace
}  // namespace tether::devices
