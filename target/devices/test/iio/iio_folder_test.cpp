#include "iio/iio_folder.h"

#include "manual_clock.h"

#include <gmock/gmock.h>

#include <tether/base_testing/scratch_folder.h>

namespace tether::devices {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
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
    return find_iio_folder(real_system(), clock_, "rangefinder " + device, device, root_);
  }
  std::string refusal(const std::string& device) {
    const auto folder = find(device);
    EXPECT_FALSE(folder);
    EXPECT_EQ(folder.failure().kind, Failure::Kind::kInvalid);
    EXPECT_THAT(folder.failure().message, StartsWith("rangefinder " + device + ": "));
    return folder.failure().message;
  }

  ScratchFolder scratch_;
  std::string root_ = scratch_.path();
  ManualClock clock_;
};

TEST_F(IioFolderTest, IsFoundByNumberByNameAndByPath) {
  EXPECT_EQ(*find("iio:device1"), scratch_.path("iio:device1"));
  EXPECT_EQ(*find("iio:vl53l0x"), scratch_.path("iio:device0"));
  EXPECT_EQ(*find(scratch_.path("iio:device0")), scratch_.path("iio:device0"));
}

TEST_F(IioFolderTest, RefusalNamesTheCandidates) {
  EXPECT_THAT(refusal("iio:vl53l1x"), AllOf(HasSubstr("vl53l0x"), HasSubstr("mpu6050")));
  EXPECT_THAT(refusal("iio:a-trigger"), Not(HasSubstr("trigger0")));
  scratch_.write("iio:device2/name", "vl53l0x\n");
  EXPECT_THAT(refusal("iio:vl53l0x"), AllOf(HasSubstr(scratch_.path("iio:device0")),
                                            HasSubstr(scratch_.path("iio:device2"))));
  EXPECT_EQ(*find("iio:device2"), scratch_.path("iio:device2"));
  refusal(scratch_.path("iio:device9"));
  refusal(scratch_.path("iio:device0/name"));
  root_ = scratch_.path("no_such");
  EXPECT_THAT(refusal("iio:vl53l0x"), HasSubstr(root_));
}

TEST_F(IioFolderTest, TheDriversNameMayBeMissing) {
  EXPECT_EQ(iio_name(real_system(), clock_, scratch_.path("iio:device0")), "vl53l0x");
  EXPECT_EQ(iio_name(real_system(), clock_, scratch_.path()), "");
}

}  // namespace
}  // namespace tether::devices
