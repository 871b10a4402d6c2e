#include "iio/imu_device.h"

#include "fake_system.h"
#include "manual_clock.h"
#include "opening.h"

#include <cerrno>
#include <cmath>

#include <gmock/gmock.h>

#include <tether/base_testing/scratch_folder.h>

namespace tether::devices {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

TEST(MountMatrix, IsReadRowByRow) {
  const auto rows = parse_mount_matrix("0, 1, 0; -1, 0, 0; 0, 0, 1");
  ASSERT_TRUE(rows);
  EXPECT_EQ((*rows)[0], (uav::Vec3{0, 1, 0}));
  EXPECT_EQ((*rows)[1], (uav::Vec3{-1, 0, 0}));
  EXPECT_EQ((*rows)[2], (uav::Vec3{0, 0, 1}));
  for (const char* text : {"", "1, 0, 0; 0, 1, 0", "1, 0; 0, 1, 0; 0, 0, 1",
                           "1, 0, 0; 0, one, 0; 0, 0, 1", "1, 0, 0; 0, 1, 0; 0, 0, 1; 0, 0, 0"}) {
    EXPECT_FALSE(parse_mount_matrix(text)) << text;
  }
}

class ImuDeviceTest : public testing::Test {
 protected:
  ImuDeviceTest() {
    write("in_accel", "1000", "-2000", "16384", "0.000598550");
    write("in_anglvel", "10", "20", "-30", "0.001064724");
  }
  void write(const std::string& base, const std::string& x, const std::string& y,
             const std::string& z, const std::string& scale, const std::string& folder = "") {
    const std::string stem = folder + base;
    scratch_.write(stem + "_x_raw", x + "\n");
    scratch_.write(stem + "_y_raw", y + "\n");
    scratch_.write(stem + "_z_raw", z + "\n");
    scratch_.write(stem + "_scale", scale + "\n");
  }
  Result<std::unique_ptr<ImuDevice>> open() {
    return ImuDevice::open(system_, time_, "IMU iio:x", folders_);
  }
  std::unique_ptr<ImuDevice> opened() { return devices::opened(open()); }
  std::string refusal() { return devices::refusal(open(), "IMU iio:x"); }
  static void expect_near(const uav::Vec3& actual, const uav::Vec3& expected) {
    EXPECT_NEAR(actual.x, expected.x, 1e-9);
    EXPECT_NEAR(actual.y, expected.y, 1e-9);
    EXPECT_NEAR(actual.z, expected.z, 1e-9);
  }

  ScratchFolder scratch_;
  ManualClock clock_;
  Timeline time_{clock_};
  FakeSystem system_;
  std::vector<std::string> folders_{scratch_.path()};
};

TEST_F(ImuDeviceTest, MeasuresInSiUnits) {
  const auto device = opened();
  clock_.advance(std::chrono::milliseconds(3));
  const auto sample = device->read();
  ASSERT_TRUE(sample);
  expect_near(sample->specific_force_m_s2, {0.59855, -1.1971, 9.8066432});
  expect_near(sample->angular_velocity_rad_s, {0.01064724, 0.02129448, -0.03194172});
  EXPECT_EQ(sample->sampled_at, SimTime(std::chrono::milliseconds(3)));
  EXPECT_EQ(sample->index, 0u);
  EXPECT_EQ(device->read()->index, 1u);
  const uav::Quat& q_WS = sample->q_WS;
  for (const double part : {q_WS.w, q_WS.x, q_WS.y, q_WS.z}) EXPECT_TRUE(std::isnan(part));
}

TEST_F(ImuDeviceTest, MountingMatrixRotatesEachQuantityItsOwnFirst) {
  scratch_.write("in_mount_matrix", "0, -1, 0; 1, 0, 0; 0, 0, 1\n");
  expect_near(opened()->read()->specific_force_m_s2, {1.1971, 0.59855, 9.8066432});
  scratch_.write("in_accel_mount_matrix", "1, 0, 0; 0, -1, 0; 0, 0, -1\n");
  const auto sample = opened()->read();
  ASSERT_TRUE(sample);
  expect_near(sample->specific_force_m_s2, {0.59855, 1.1971, -9.8066432});
  expect_near(sample->angular_velocity_rad_s, {-0.02129448, 0.01064724, -0.03194172});
}

TEST_F(ImuDeviceTest, AccelerometerAndGyroscopeMayBeTwoDevices) {
  for (const char* axis : {"x", "y", "z"}) {
    std::filesystem::remove(scratch_.path(std::string("in_anglvel_") + axis + "_raw"));
  }
  EXPECT_THAT(refusal(), HasSubstr("in_anglvel"));
  write("in_anglvel", "1", "2", "3", "0.5", "gyro/");
  folders_.push_back(scratch_.path("gyro"));
  expect_near(opened()->read()->angular_velocity_rad_s, {0.5, 1.0, 1.5});
}

TEST_F(ImuDeviceTest, FailsForGoodWithItsFirstError) {
  const auto device = opened();
  ASSERT_TRUE(device->read());
  for (const int error : {EIO, ENODEV}) {
    system_.read_errors[scratch_.path("in_anglvel_y_raw")] = {error};
    const auto none = device->read();
    ASSERT_FALSE(none);
    EXPECT_EQ(none.failure().kind, Failure::Kind::kDisconnected);
    EXPECT_THAT(
        none.failure().message,
        AllOf(StartsWith("IMU iio:x "), HasSubstr("in_anglvel_y_raw"), HasSubstr(error_text(EIO))));
  }
}

TEST_F(ImuDeviceTest, RefusalNamesTheFileOrQuantity) {
  scratch_.write("in_mount_matrix", "upside down\n");
  EXPECT_THAT(refusal(), AllOf(HasSubstr("in_mount_matrix"), HasSubstr("upside down")));
  std::filesystem::remove(scratch_.path("in_mount_matrix"));
  const std::string axis = scratch_.path("in_accel_x_raw");
  system_.read_errors[axis] = {EBUSY};
  EXPECT_THAT(refusal(), HasSubstr(axis));
  system_.open_errors[axis] = EACCES;
  EXPECT_THAT(refusal(), HasSubstr(axis));
  std::filesystem::remove(scratch_.path("in_accel_z_raw"));
  system_.open_errors.clear();
  EXPECT_THAT(refusal(), HasSubstr("in_accel_x, _y and _z"));
}

}  // namespace
}  // namespace tether::devices
