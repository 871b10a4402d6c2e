#include <cmath>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include <tether/base/units.h>
#include <tether/rig/rig_file.h>

namespace tether::rig {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

devices::Rig parsed(const std::string& text) {
  Result<devices::Rig> rig = parse_rig(text, "data/rigs/r.toml");
  EXPECT_TRUE(rig) << rig.failure().message;
  return rig ? *rig : devices::Rig{};
}

const uav::CameraModel& camera_of(const devices::RigSensor& sensor) {
  return std::get<uav::CameraProperties>(sensor.description.properties).model;
}

TEST(RigFile, SaysOfSensorsAndAnchorsWhatACatalogueSays) {
  const devices::Rig rig = parsed(R"(
uav = "bench"
[sensors.camera]
kind = "camera"
device = "/dev/video0"
size_px = [640, 480]
intrinsics = { fx_px = 500, fy_px = 501.5, cx_px = 320, cy_px = 240 }
distortion = { k1 = -0.1, k2 = 0.02, k3 = 0.003, p1 = 0.001, p2 = -0.002 }
position_m = [0.1, 0, 0.05]
rpy_deg = [0, 0, 90]
[sensors.imu]
kind = "imu"
[sensors.range]
kind = "range"
device = "iio:vl53l0x"
min_m = 0.04
max_m = 2
[[anchor]]
name = "blue_box"
shape = "box"
size_m = [0.4, 0.3, 0.2]
color_rgb = [0.05, 0.15, 0.85]
[[anchor]]
name = "ball"
shape = "sphere"
size_m = [0.2, 0.2, 0.2]
color_rgb = [1, 0, 0]
)");
  EXPECT_EQ(rig.uav, "bench");
  ASSERT_EQ(rig.sensors.size(), 3u);
  const devices::RigSensor& camera = rig.sensors[0];
  EXPECT_EQ(camera.description.name, "camera");
  EXPECT_EQ(camera.device, "/dev/video0");
  EXPECT_EQ(camera.description.X_BS.p, (uav::Vec3{0.1, 0, 0.05}));
  EXPECT_NEAR(uav::yaw_rad(camera.description.X_BS.q), rad_from_deg(90), 1e-12);
  const uav::CameraModel& model = camera_of(camera);
  EXPECT_EQ(model.width_px, 640);
  EXPECT_EQ(model.height_px, 480);
  EXPECT_EQ(model.fx_px, 500.0);
  EXPECT_EQ(model.fy_px, 501.5);
  EXPECT_EQ(model.cx_px, 320.0);
  EXPECT_EQ(model.cy_px, 240.0);
  EXPECT_EQ(model.k1, -0.1);
  EXPECT_EQ(model.k2, 0.02);
  EXPECT_EQ(model.k3, 0.003);
  EXPECT_EQ(model.p1, 0.001);
  EXPECT_EQ(model.p2, -0.002);

  EXPECT_EQ(rig.sensors[1].description.kind(), uav::SensorKind::kImu);
  EXPECT_EQ(rig.sensors[1].device, "");
  EXPECT_EQ(rig.sensors[2].device, "iio:vl53l0x");
  const auto& range = std::get<uav::RangeProperties>(rig.sensors[2].description.properties);
  EXPECT_EQ(range.min_m, 0.04);
  EXPECT_EQ(range.max_m, 2.0);

  ASSERT_EQ(rig.anchors.size(), 2u);
  EXPECT_EQ(rig.anchors[0].name, "blue_box");
  EXPECT_EQ(rig.anchors[0].shape, uav::AnchorShape::kBox);
  EXPECT_EQ(rig.anchors[0].size_m, (uav::Vec3{0.4, 0.3, 0.2}));
  EXPECT_EQ(rig.anchors[0].color_rgb, (uav::Vec3{0.05, 0.15, 0.85}));
  EXPECT_EQ(rig.anchors[1].shape, uav::AnchorShape::kSphere);
}

TEST(RigFile, WhatItDoesNotSayIsLeftOpen) {
  const devices::Rig rig =
      parsed("[sensors.eye]\nkind = \"camera\"\n[sensors.range]\nkind = \"range\"\n");
  EXPECT_EQ(rig.uav, "rig");
  const uav::CameraModel& model = camera_of(rig.sensors[0]);
  EXPECT_EQ(model.width_px, 0);
  EXPECT_EQ(model.fx_px, 0.0);
  const auto& range = std::get<uav::RangeProperties>(rig.sensors[1].description.properties);
  EXPECT_EQ(range.min_m, 0.0);
  EXPECT_TRUE(std::isinf(range.max_m));
  EXPECT_TRUE(rig.anchors.empty());
}

TEST(RigFile, AFieldOfViewIsALens) {
  const devices::Rig rig = parsed(
      "[sensors.eye]\nkind = \"camera\"\nsize_px = [640, 480]\nhorizontal_fov_deg = 80\n"
      "distortion = { k1 = 0.1 }\n");
  const uav::CameraModel& model = camera_of(rig.sensors[0]);
  EXPECT_NEAR(model.fx_px, 320.0 / std::tan(rad_from_deg(40)), 1e-9);
  EXPECT_EQ(model.cx_px, 319.5);
  EXPECT_EQ(model.k1, 0.1);
}

TEST(RigFile, AFieldOfViewIsOfAnySize) {
  const devices::Rig rig = parsed(
      "[sensors.eye]\nkind = \"camera\"\nhorizontal_fov_deg = 80\ndistortion = { k1 = 0.1 }\n");
  EXPECT_DOUBLE_EQ(rig.sensors[0].horizontal_fov_rad, rad_from_deg(80));
  const uav::CameraModel& model = camera_of(rig.sensors[0]);
  EXPECT_EQ(model.width_px, 0) << "the device's";
  EXPECT_EQ(model.fx_px, 0.0);
  EXPECT_EQ(model.k1, 0.1);
}

TEST(RigFile, ARelativeDeviceIsBesideTheFile) {
  const auto device = [](const std::string& text) {
    return parsed("[sensors.eye]\nkind = \"camera\"\ndevice = \"" + text + "\"\n")
        .sensors[0]
        .device;
  };
  EXPECT_EQ(device("./box.avi"), "data/rigs/box.avi");
  EXPECT_EQ(device("../data/box.avi"), "data/data/box.avi");
  EXPECT_EQ(device("/data/box.avi"), "/data/box.avi");
  EXPECT_EQ(device("rtsp://eye/0"), "rtsp://eye/0");
  EXPECT_EQ(device("2"), "2");
}

struct Mistake {
  const char* text;
  int line;
  const char* says;
};

TEST(RigFile, MistakesNameFileAndLine) {
  const std::vector<Mistake> mistakes = {
      {"", 1, "needs a [sensors.NAME]"},
      {"sensors = 3\n", 1, "'sensors' of the file must be a table"},
      {"[sensors]\n", 1, "needs a [sensors.NAME]"},
      {"[sensors]\ncamera = 3\n", 2, "'camera' of [sensors] must be a table"},
      {"[sensors.c\n", 1, "no valid TOML"},
      {"speed = 1\n[sensors.c]\nkind = \"imu\"\n", 1, "unknown key 'speed' in the file"},
      {"[sensors.c]\nposition_m = [0, 0, 0]\n", 1, "[sensors.c] lacks the key 'kind'"},
      {"[sensors.c]\nkind = \"radar\"\n", 2, "Allowed: 'camera', 'imu' and 'range'"},
      {"[sensors.c]\nkind = \"imu\"\nsize_px = [1, 1]\n", 3,
       "unknown key 'size_px' in [sensors.c]"},
      {"[sensors.c]\nkind = \"imu\"\ndevice = \"imu0\"\n", 3, "is \"imu0\", which is no device"},
      {"[sensors.c]\nkind = \"imu\"\ndevice = 0\n", 3, "'device' of [sensors.c] must be a string"},
      {"[sensors.c]\nkind = \"imu\"\nposition_m = [0, 0]\n", 3,
       "must be an array of 3 numbers, but has 2 elements"},
      {"[sensors.c]\nkind = \"imu\"\nposition_m = [0, 0, nan]\n", 3,
       "must be at least -1000 and at most 1000, but is nan"},
      {"[sensors.c]\nkind = \"imu\"\nrpy_deg = [0, 0, 400]\n", 3,
       "must be at least -360 and at most 360, but is 400"},
      {"[sensors.c]\nkind = \"camera\"\nsize_px = [0, 480]\n", 3,
       "must be at least 1 and at most 16384, but is 0"},
      {"[sensors.c]\nkind = \"camera\"\nsize_px = [1.5, 480]\n", 3, "whole numbers"},
      {"[sensors.c]\nkind = \"camera\"\nintrinsics = { fx_px = 1, fy_px = 1 }\n", 3,
       "needs size_px"},
      {"[sensors.c]\nkind = \"camera\"\nsize_px = [4, 4]\nhorizontal_fov_deg = 180\n", 4,
       "must be at least 1 and at most 179, but is 180"},
      {"[sensors.c]\nkind = \"camera\"\nsize_px = [4, 4]\nhorizontal_fov_deg = 60\n"
       "intrinsics = { fx_px = 1, fy_px = 1 }\n",
       5, "say the same"},
      {"[sensors.c]\nkind = \"camera\"\nsize_px = [4, 4]\nintrinsics = { fx_px = 1 }\n", 4,
       "[sensors.c.intrinsics] lacks the key 'fy_px'"},
      {"[sensors.c]\nkind = \"camera\"\ndistortion = { k1 = 0.1 }\n", 3,
       "needs horizontal_fov_deg"},
      {"[sensors.c]\nkind = \"range\"\nmin_m = -1\n", 3, "must be at least 0"},
      {"[sensors.c]\nkind = \"range\"\nmin_m = 2\nmax_m = 1\n", 4, "more than min_m"},
      {"[[anchor]]\nname = \"a\"\n", 1, "needs a [sensors.NAME]"},
  };
  for (const Mistake& mistake : mistakes) {
    const Result<devices::Rig> rig = parse_rig(mistake.text, "r.toml");
    ASSERT_FALSE(rig) << mistake.text;
    EXPECT_EQ(rig.failure().kind, Failure::Kind::kInvalid);
    EXPECT_THAT(rig.failure().message, StartsWith("r.toml:" + std::to_string(mistake.line) + ": "));
    EXPECT_THAT(rig.failure().message, HasSubstr(mistake.says));
    EXPECT_THAT(rig.failure().message, ::testing::Not(HasSubstr("\n")));
  }
}

TEST(RigFile, MistakesOfAnchors) {
  const std::string start = "[sensors.c]\nkind = \"imu\"\n[[anchor]]\nname = \"a\"\n";
  const std::vector<Mistake> mistakes = {
      {"", 3, "[anchor] lacks the key 'shape'"},
      {"shape = \"cone\"\n", 5, "Allowed: 'box', 'cylinder' and 'sphere'"},
      {"shape = \"box\"\nsize_m = [1, 1, 0]\n", 6, "must be at least 1e-06"},
      {"shape = \"box\"\nsize_m = [1, 1, 1]\ncolor_rgb = [0, 0, 255]\n", 7,
       "must be at least 0 and at most 1, but is 255"},
      {"shape = \"cylinder\"\nsize_m = [1, 2, 1]\ncolor_rgb = [0, 0, 1]\n", 6, "diameter"},
      {"shape = \"sphere\"\nsize_m = [1, 1, 2]\ncolor_rgb = [0, 0, 1]\n", 6, "diameter"},
      {"shape = \"box\"\nsize_m = [1, 1, 1]\ncolor_rgb = [0, 0, 1]\n[[anchor]]\nname = \"a\"\n"
       "shape = \"box\"\nsize_m = [1, 1, 1]\ncolor_rgb = [0, 0, 1]\n",
       8, "two of the name"},
  };
  for (const Mistake& mistake : mistakes) {
    const Result<devices::Rig> rig = parse_rig(start + mistake.text, "r.toml");
    ASSERT_FALSE(rig) << mistake.text;
    EXPECT_THAT(rig.failure().message, StartsWith("r.toml:" + std::to_string(mistake.line) + ": "));
    EXPECT_THAT(rig.failure().message, HasSubstr(mistake.says));
  }
}

TEST(RigFile, WhatCannotBeReadIsNamed) {
  const Result<devices::Rig> rig = load_rig("/nowhere/r.toml");
  ASSERT_FALSE(rig);
  EXPECT_EQ(rig.failure().message, "/nowhere/r.toml: there is no such file");
}

TEST(RigFile, TheShippedBenchHasTheRoomsBlueBox) {
  const Result<devices::Rig> rig = load_rig(TETHER_SOURCE_DIR "/data/rigs/bench.toml");
  ASSERT_TRUE(rig) << rig.failure().message;
  ASSERT_EQ(rig->anchors.size(), 1u);
  EXPECT_EQ(rig->anchors[0].name, "blue_box");
  // As in data/worlds/room.sdf.
  EXPECT_EQ(rig->anchors[0].size_m, (uav::Vec3{0.4, 0.4, 0.4}));
  EXPECT_EQ(rig->anchors[0].color_rgb, (uav::Vec3{0.05, 0.15, 0.85}));
}

}  // namespace
}  // namespace tether::rig
