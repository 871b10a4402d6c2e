#include <gtest/gtest.h>

#include <tether/devices/rig.h>

namespace tether::devices {
namespace {

TEST(IsDevice, PathsUrlsNumbersAndIioNamesAreDevices) {
  for (const char* text : {"/dev/video0", "clip/a.avi", "./a.avi", "rtsp://cam:554/s", "0", "12",
                           "iio:vl53l0x", "iio:device3", "/sys/bus/iio/devices/iio:device0"}) {
    EXPECT_TRUE(is_device(text)) << text;
  }
}

TEST(IsDevice, SensorNamesAreNot) {
  for (const char* text :
       {"", "camera", "front_camera", "camera0", "0a", "-1", "iio", "my_iio:x"}) {
    EXPECT_FALSE(is_device(text)) << text;
  }
}

}  // namespace
}  // namespace tether::devices
