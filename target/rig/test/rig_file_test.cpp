#include "rig_file.h"

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include <tether/base/units.h>

namespace tether::rig {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

devices::Rig rig_from(const std::string& text) {
  Result<devices::Rig> rig = parse_rig(text, "data/rigs/r.toml");
  EXPECT_TRUE(rig) << rig.failure().message;
  return rig ? *rig : devices::Rig{};
}

const uav::CameraModel& camera_of(const devices::RigSensor& sensor) {
  return std::get<uav::CameraProperties>(sensor.description.properties).model;
}

TEST(RigFile, DescribesSensorsAndAnchors) {
  const devices::Rig rig = rig_from(R"(
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
  EXPECT_EQ(std::pair(model.width_px, model.height_px), std::pair(640, 480));
  EXPECT_THAT((std::array{model.fx_px, model.fy_px, model.cx_px, model.cy_px}),
              ElementsAre(500.0, 501.5, 320.0, 240.0));
  EXPECT_THAT((std::array{model.k1, model.k2, model.k3, model.p1, model.p2}),
              ElementsAre(-0.1, 0.02, 0.003, 0.001, -0.002));
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

TEST(RigFile, MissingKeysHaveDefaults) {
  const devices::Rig rig =
      rig_from("[sensors.eye]\nkind = \"camera\"\n[sensors.range]\nkind = \"range\"\n");
  EXPECT_EQ(rig.uav, "rig");
  const uav::CameraModel& model = camera_of(rig.sensors[0]);
  EXPECT_EQ(model.width_px, 0);
  EXPECT_EQ(model.fx_px, 0.0);
  const auto& range = std::get<uav::RangeProperties>(rig.sensors[1].description.properties);
  EXPECT_EQ(range.min_m, 0.0);
  EXPECT_TRUE(std::isinf(range.max_m));
  EXPECT_TRUE(rig.anchors.empty());
}

TEST(RigFile, FieldOfViewGivesFocalLengthsForAGivenSize) {
  const std::string eye =
      "[sensors.eye]\nkind = \"camera\"\nhorizontal_fov_deg = 80\ndistortion = { k1 = 0.1 }\n";
  const devices::Rig sized = rig_from(eye + "size_px = [640, 480]\n");
  EXPECT_NEAR(camera_of(sized.sensors[0]).fx_px, 320.0 / std::tan(rad_from_deg(40)), 1e-9);
  EXPECT_EQ(camera_of(sized.sensors[0]).cx_px, 319.5);
  EXPECT_EQ(camera_of(sized.sensors[0]).k1, 0.1);
  const devices::Rig open = rig_from(eye);  // the size is the device's
  EXPECT_DOUBLE_EQ(open.sensors[0].horizontal_fov_rad, rad_from_deg(80));
  EXPECT_EQ(camera_of(open.sensors[0]).width_px, 0);
  EXPECT_EQ(camera_of(open.sensors[0]).fx_px, 0.0);
  EXPECT_EQ(camera_of(open.sensors[0]).k1, 0.1);
}

TEST(RigFile, ARelativeDeviceIsBesideTheFile) {
  const auto device = [](const std::string& text) {
    return rig_from("[sensors.eye]\nkind = \"camera\"\ndevice = \"" + text + "\"\n")
        .sensors[0]
        .device;
  };
  EXPECT_EQ(device("./box.avi"), "data/rigs/box.avi");
  EXPECT_EQ(device("../data/box.avi"), "data/data/box.avi");
  EXPECT_EQ(device("/data/box.avi"), "/data/box.avi");
  EXPECT_EQ(device("rtsp://eye/0"), "rtsp://eye/0");
  EXPECT_EQ(device("2"), "2");
}

TEST(RigFile, RefusalNamesLineAndKey) {
  struct Case {
    std::string text;
    int line;
    const char* key;
  };
  const std::string imu = "[sensors.c]\nkind = \"imu\"\n",
                    range = "[sensors.c]\nkind = \"range\"\n",
                    camera = "[sensors.c]\nkind = \"camera\"\n",
                    sized = camera + "size_px = [4, 4]\n",
                    anchor = imu + "[[anchor]]\nname = \"a\"\n",
                    box = "shape = \"box\"\nsize_m = [1, 1, 1]\ncolor_rgb = [0, 0, 1]\n";
  for (const Case& c : std::vector<Case>{
           {"", 1, "[sensors.NAME]"},
           {"sensors = 3\n", 1, "'sensors'"},
           {"[sensors]\n", 1, "[sensors.NAME]"},
           {"[sensors]\ncamera = 3\n", 2, "'camera'"},
           {"[sensors.c\n", 1, ""},
           {"speed = 1\n" + imu, 1, "'speed'"},
           {"[sensors.c]\nposition_m = [0, 0, 0]\n", 1, "'kind'"},
           {"[sensors.c]\nkind = \"radar\"\n", 2, "\"radar\""},
           {imu + "size_px = [1, 1]\n", 3, "'size_px'"},
           {imu + "device = \"imu0\"\n", 3, "\"imu0\""},
           {imu + "position_m = [0, 0]\n", 3, "'position_m'"},
           {imu + "position_m = [0, 0, nan]\n", 3, "1000"},
           {imu + "rpy_deg = [0, 0, 400]\n", 3, "360"},
           {camera + "size_px = [0, 480]\n", 3, "16384"},
           {camera + "size_px = [1.5, 480]\n", 3, "'size_px'"},
           {camera + "intrinsics = { fx_px = 1, fy_px = 1 }\n", 3, "size_px"},
           {camera + "distortion = { k1 = 0.1 }\n", 3, "horizontal_fov_deg"},
           {sized + "horizontal_fov_deg = 180\n", 4, "179"},
           {sized + "horizontal_fov_deg = 60\nintrinsics = { fx_px = 1, fy_px = 1 }\n", 5,
            "intrinsics"},
           {sized + "intrinsics = { fx_px = 1 }\n", 4, "'fy_px'"},
           {range + "min_m = -1\n", 3, "'min_m'"},
           {range + "min_m = 2\nmax_m = 1\n", 4, "min_m"},
           {anchor, 3, "'shape'"},
           {anchor + "shape = \"cone\"\n", 5, "\"cone\""},
           {anchor + "shape = \"box\"\nsize_m = [1, 1, 0]\n", 6, "1e-06"},
           {anchor + "shape = \"box\"\nsize_m = [1, 1, 1]\ncolor_rgb = [0, 0, 255]\n", 7, "255"},
           {anchor + "shape = \"cylinder\"\nsize_m = [1, 2, 1]\ncolor_rgb = [0, 0, 1]\n", 6,
            "size_m"},
           {anchor + "shape = \"sphere\"\nsize_m = [1, 1, 2]\ncolor_rgb = [0, 0, 1]\n", 6,
            "size_m"},
           {anchor + box + "[[anchor]]\nname = \"a\"\n" + box, 8, "\"a\""}}) {
    const Result<devices::Rig> rig = parse_rig(c.text, "r.toml");
    ASSERT_FALSE(rig) << c.text;
    EXPECT_EQ(rig.failure().kind, Failure::Kind::kInvalid);
    EXPECT_THAT(rig.failure().message,
                AllOf(StartsWith("r.toml:" + std::to_string(c.line) + ": "), HasSubstr(c.key)))
        << c.text;
  }
  EXPECT_THAT(load_rig("/nowhere/r.toml").failure().message, StartsWith("/nowhere/r.toml"));
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
