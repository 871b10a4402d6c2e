#include "camera/video4linux.h"

#include "fake_system.h"

#include <cerrno>

#include <gmock/gmock.h>
#include <linux/videodev2.h>

namespace tether::devices {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

const std::string kPath = "/dev/video7";

/// A driver that captures, in a format that OpenCV does not know, and refuses one call.
struct Driver {
  std::uint32_t capabilities = V4L2_CAP_DEVICE_CAPS;
  std::uint32_t device_caps = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
  unsigned long refused = 0;
  int error = 0;
  int buffers = 0;

  int answer(unsigned long request, void* argument) {
    if (request == refused) return -error;
    switch (request) {
      case VIDIOC_QUERYCAP:
        static_cast<v4l2_capability*>(argument)->capabilities = capabilities;
        static_cast<v4l2_capability*>(argument)->device_caps = device_caps;
        return 0;
      case VIDIOC_G_FMT:
        static_cast<v4l2_format*>(argument)->fmt.pix.pixelformat = v4l2_fourcc('p', 'B', 'A', 'A');
        return 0;
      case VIDIOC_S_FMT:
        return 0;
      case VIDIOC_REQBUFS:
        buffers = static_cast<int>(static_cast<v4l2_requestbuffers*>(argument)->count);
        return 0;
      default:
        return -ENOTTY;
    }
  }
};

class Video4LinuxTest : public testing::Test {
 protected:
  Video4LinuxTest() {
    system_.nodes[kPath] = FileKind::kCharacterDevice;
    system_.on_ioctl = [this](unsigned long request, void* argument) {
      return driver_.answer(request, argument);
    };
  }
  std::string fault() {
    const std::string text = video4linux_fault(system_, kPath);
    EXPECT_EQ(system_.open_descriptors, 0);
    EXPECT_EQ(driver_.buffers, 0) << "a buffer was left with the driver";
    return text;
  }
  void refuse(unsigned long request, int error) {
    driver_.refused = request;
    driver_.error = error;
  }

  FakeSystem system_;
  Driver driver_;
};

TEST_F(Video4LinuxTest, ReportsWhyTheDeviceCannotBeOpened) {
  for (const auto& [error, advice] :
       {std::pair(EACCES, "group video"), std::pair(ENOENT, "v4l2-ctl --list-devices"),
        std::pair(ENODEV, "v4l2-ctl --list-devices"), std::pair(EBUSY, "fuser -v /dev/video7"),
        std::pair(EIO, "dmesg")}) {
    system_.open_errors[kPath] = error;
    EXPECT_THAT(fault(), HasSubstr(advice)) << error;
  }
}

TEST_F(Video4LinuxTest, ReportsDevicesThatCaptureNothing) {
  EXPECT_THAT(video4linux_fault(real_system(), "/dev/null"), StartsWith("not a video device"));
  driver_.capabilities = V4L2_CAP_VIDEO_CAPTURE;  // an old driver has no capabilities per device
  driver_.device_caps = 0;
  EXPECT_THAT(fault(), HasSubstr("pBAA"));
  // The capabilities of another node of the same camera do not count.
  driver_.capabilities |= V4L2_CAP_DEVICE_CAPS;
  driver_.device_caps = V4L2_CAP_META_CAPTURE;
  EXPECT_THAT(fault(), AllOf(HasSubstr("v4l2-ctl --list-devices"), Not(HasSubstr("pBAA"))));
}

TEST_F(Video4LinuxTest, ReportsTheCallThatTheDriverRefuses) {
  EXPECT_THAT(fault(), AllOf(HasSubstr("pBAA"), HasSubstr("libcamerify")));
  for (const unsigned long request : {VIDIOC_S_FMT, VIDIOC_REQBUFS}) {
    refuse(request, EBUSY);
    EXPECT_THAT(fault(), HasSubstr("fuser -v /dev/video7"));
  }
  refuse(VIDIOC_G_FMT, EINVAL);
  EXPECT_THAT(fault(), HasSubstr("v4l2-ctl -d /dev/video7 --all"));
}

}  // namespace
}  // namespace tether::devices
