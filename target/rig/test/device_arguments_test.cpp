#include <string>

#include <gmock/gmock.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/rig/device_arguments.h>

namespace tether::rig {
namespace {

using ::testing::HasSubstr;

constexpr const char* kLens = "size_px = [640, 480]\nhorizontal_fov_deg = 60\n";

Mission mission_of(TaskOptions options) {
  TaskSpec spec;
  spec.options = std::move(options);
  spec.anchor = "blue_box";
  spec.sensor = "camera";
  return {{spec}, false};
}

devices::Rig made(const DeviceArguments& arguments, Mission& mission) {
  const auto rig = make_rig(arguments, mission);
  EXPECT_TRUE(rig) << rig.failure().message;
  EXPECT_TRUE(*rig);
  return rig && *rig ? **rig : devices::Rig{};
}

std::string refused(const DeviceArguments& arguments, Mission mission) {
  const auto rig = make_rig(arguments, mission);
  EXPECT_FALSE(rig);
  if (rig) return "";
  EXPECT_EQ(rig.failure().kind, Failure::Kind::kInvalid);
  return rig.failure().message;
}

class MakeRig : public ::testing::Test {
 protected:
  std::string rig_file(const std::string& text) const { return folder_.write("rig.toml", text); }

  ScratchFolder folder_;
};

TEST(TakeDevices, LeavesNamesWhereTheyAre) {
  Mission mission = mission_of(tasks::ClosedPathOptions{});
  DeviceArguments arguments;
  take_devices(mission.tasks[0], arguments);
  EXPECT_EQ(mission.tasks[0].vision.camera, "camera");
  EXPECT_EQ(arguments.camera + arguments.imu, "");
  EXPECT_FALSE(*make_rig(arguments, mission)) << "a coordinator is meant";
}

TEST_F(MakeRig, WithoutAFileOnlyTheDevicesAreKnown) {
  Mission mission = mission_of(tasks::SensorCharacterizationOptions{});
  const devices::Rig rig =
      made({.rig = "", .camera = "/dev/video0", .imu = "", .range = "iio:vl53l0x"}, mission);
  ASSERT_EQ(rig.sensors.size(), 2u);
  EXPECT_EQ(rig.sensors[0].description.name, "camera");
  EXPECT_EQ(rig.sensors[0].device, "/dev/video0");
  EXPECT_EQ(rig.sensors[1].description.name, "range");
  EXPECT_EQ(rig.sensors[1].device, "iio:vl53l0x");
}

TEST_F(MakeRig, DeviceOfTheCommandLineReplacesThatOfTheFile) {
  Mission mission = mission_of(tasks::ClosedPathOptions{});
  mission.tasks[0].vision.camera = "/dev/video7";
  std::get<tasks::ClosedPathOptions>(mission.tasks[0].options).imu = "iio:bmi160";
  DeviceArguments arguments;
  take_devices(mission.tasks[0], arguments);
  arguments.rig =
      rig_file(std::string("[sensors.eye]\nkind = \"camera\"\ndevice = \"/dev/video0\"\n") + kLens +
               "[sensors.gyro]\nkind = \"imu\"\n[sensors.range]\nkind = \"range\"\n");
  const devices::Rig rig = made(arguments, mission);
  ASSERT_EQ(rig.sensors.size(), 2u) << "the rangefinder has no device";
  EXPECT_EQ(rig.sensors[0].device, "/dev/video7");
  EXPECT_EQ(rig.sensors[1].device, "iio:bmi160");
  EXPECT_EQ(mission.tasks[0].vision.camera, "eye") << "the task uses the name of the sensor";
  EXPECT_EQ(std::get<tasks::ClosedPathOptions>(mission.tasks[0].options).imu, "gyro");
}

TEST_F(MakeRig, PrefersSensorNamedAsItsKind) {
  const std::string two = "[sensors.a]\nkind = \"imu\"\n[sensors.b]\nkind = \"imu\"\n";
  Mission mission = mission_of(tasks::SensorCharacterizationOptions{});
  mission.tasks[0].sensor = "imu";
  const DeviceArguments arguments{.rig = rig_file(two), .camera = "", .imu = "./x", .range = ""};
  EXPECT_THAT(refused(arguments, mission), HasSubstr("--imu"));
  rig_file(two + "[sensors.imu]\nkind = \"imu\"\n");
  const devices::Rig rig = made(arguments, mission);
  ASSERT_EQ(rig.sensors.size(), 1u);
  EXPECT_EQ(rig.sensors[0].description.name, "imu");
}

TEST_F(MakeRig, TaskWithAnAnchorNeedsTheLens) {
  DeviceArguments arguments{.rig = "", .camera = "/dev/video0", .imu = "", .range = ""};
  EXPECT_THAT(refused(arguments, mission_of(tasks::RelativePositionOptions{})), HasSubstr("--rig"));
  const std::string camera = "[sensors.camera]\nkind = \"camera\"\n";
  arguments.rig = rig_file(camera);
  EXPECT_THAT(refused(arguments, mission_of(tasks::RelativePositionOptions{})),
              HasSubstr("horizontal_fov_deg"));
  Mission timing = mission_of(tasks::SensorCharacterizationOptions{});
  EXPECT_EQ(made(arguments, timing).sensors.size(), 1u) << "which needs no lens";
  rig_file(camera + "horizontal_fov_deg = 60\n");
  Mission position = mission_of(tasks::RelativePositionOptions{});
  EXPECT_GT(made(arguments, position).sensors.at(0).horizontal_fov_rad, 1.0);
}

TEST_F(MakeRig, SensorOfATaskNeedsADevice) {
  DeviceArguments arguments;
  arguments.rig = rig_file(std::string("[sensors.camera]\nkind = \"camera\"\n") + kLens +
                           "[sensors.imu]\nkind = \"imu\"\n");
  EXPECT_THAT(refused(arguments, mission_of(tasks::RelativePositionOptions{})),
              HasSubstr("--camera"));
  refused(arguments, {});
  arguments.camera = "0";
  EXPECT_THAT(refused(arguments, mission_of(tasks::ClosedPathOptions{})), HasSubstr("--imu"));
  arguments.rig = "/nowhere/r.toml";
  EXPECT_THAT(refused(arguments, {}), HasSubstr(arguments.rig));
}

}  // namespace
}  // namespace tether::rig
