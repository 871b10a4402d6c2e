#include "iio_folder.h"

#include "manual_clock.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>

namespace tether::devices {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

class IioFolderTest : public testing::Test {
 protected:
  IioFolderTest() {
    scratch_.write("iio:device0/name", "vl53l0x\n");
    scratch_.write("iio:device1/name", "mpu6050\n");
    scratch_.write("iio:device1/in_accel_x_raw", "1\n");
    scratch_.write("trigger0/name", "a-trigger\n");
  }
  Result<std::string> find(const std::string& device) {
    return find_iio_folder(real_system(), clock_, "rangefinder " + device, device, scratch_.path());
  }
  std::string refusal(const std::string& device) {
    const auto folder = find(device);
    if (folder) return "found";
    EXPECT_EQ(folder.failure().kind, Failure::Kind::kInvalid);
    EXPECT_THAT(folder.failure().message, StartsWith("rangefinder " + device + ": "));
    return folder.failure().message;
  }

  ScratchFolder scratch_;
  ManualClock clock_;
};

TEST_F(IioFolderTest, IsFoundByNumberByNameAndByPath) {
  EXPECT_EQ(*find("iio:device1"), scratch_.path("iio:device1"));
  EXPECT_EQ(*find("iio:vl53l0x"), scratch_.path("iio:device0"));
  EXPECT_EQ(*find(scratch_.path("iio:device0")), scratch_.path("iio:device0"));
}

TEST_F(IioFolderTest, WhatIsThereIsSaidWhereTheNameIsNot) {
  EXPECT_THAT(refusal("iio:vl53l1x"),
              AllOf(HasSubstr("iio:device0 (vl53l0x)"), HasSubstr("iio:device1 (mpu6050)")));
  EXPECT_THAT(refusal("iio:a-trigger"), HasSubstr("no sensor of this name"));
}

TEST_F(IioFolderTest, TwoOfTheSameNameAreBothNamed) {
  scratch_.write("iio:device2/name", "vl53l0x\n");
  EXPECT_THAT(refusal("iio:vl53l0x"), AllOf(HasSubstr(scratch_.path("iio:device0")),
                                            HasSubstr(scratch_.path("iio:device2"))));
  EXPECT_EQ(*find("iio:device2"), scratch_.path("iio:device2"));
}

TEST_F(IioFolderTest, AKernelWithoutSensors) {
  const auto none =
      find_iio_folder(real_system(), clock_, "IMU iio:a", "iio:a", scratch_.path("no_such"));
  EXPECT_THAT(none.failure().message,
              AllOf(StartsWith("IMU iio:a: the kernel shows no sensor"), HasSubstr("driver")));
}

TEST_F(IioFolderTest, AFolderMustBeThere) {
  EXPECT_THAT(refusal(scratch_.path("iio:device9")), HasSubstr("No such file or directory"));
  EXPECT_THAT(refusal(scratch_.path("iio:device0/name")), HasSubstr("not a folder"));
}

TEST_F(IioFolderTest, TheDriversNameMayBeMissing) {
  EXPECT_EQ(iio_name(real_system(), clock_, scratch_.path("iio:device0")), "vl53l0x");
  EXPECT_EQ(iio_name(real_system(), clock_, scratch_.path()), "");
}

}  // namespace
}  // namespace tether::devices
