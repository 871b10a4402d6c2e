#include "camera/video4linux.h"

#include <cerrno>
#include <cstring>

#include <linux/videodev2.h>

namespace tether::devices {
namespace {

constexpr const char* kListDevices = "`v4l2-ctl --list-devices` lists the cameras";

std::string busy(const std::string& path) {
  return "busy: another program uses it; `fuser -v " + path + "` shows which one";
}

std::string open_fault(const std::string& path, int error) {
  switch (error) {
    case EACCES:
    case EPERM:
      return "permission denied; add the user to the group video (`sudo usermod -aG video "
             "$USER`), then log in again";
    case EBUSY:
      return busy(path);
    case ENOENT:
    case ENODEV:
    case ENXIO:
      return error_text(error) + std::string("; ") + kListDevices;
    default:
      return error_text(error) + "; see `dmesg`";
  }
}

/// 'YUYV'
std::string four_characters(std::uint32_t code) {
  std::string text;
  for (int shift = 0; shift < 32; shift += 8) {
    const char c = static_cast<char>((code >> shift) & 0x7fU);
    text += c >= ' ' && c <= '~' ? c : '?';
  }
  return text;
}

/// Empty: it captures images, and says so.
std::string capability_fault(System& system, int descriptor) {
  v4l2_capability capability{};
  if (system.ioctl(descriptor, VIDIOC_QUERYCAP, &capability) < 0) {
    return std::string("not a video device; ") + kListDevices;
  }
  const bool own = (capability.capabilities & V4L2_CAP_DEVICE_CAPS) != 0;
  const std::uint32_t can = own ? capability.device_caps : capability.capabilities;
  if ((can & (V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_VIDEO_CAPTURE_MPLANE)) != 0) return {};
  return std::string(
             "a video device without images; a camera often has several devices, of which the one "
             "with the lowest number has the images; ") +
         kListDevices;
}

/// Asks for the format that the device already has, and for a buffer: what a driver refuses while
/// another program uses the device.
std::string capture_fault(System& system, int descriptor, const std::string& path) {
  v4l2_format format{};
  format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  if (system.ioctl(descriptor, VIDIOC_G_FMT, &format) < 0) return {};
  if (system.ioctl(descriptor, VIDIOC_S_FMT, &format) == -EBUSY) return busy(path);
  v4l2_requestbuffers request{};
  request.count = 1;
  request.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  request.memory = V4L2_MEMORY_MMAP;
  const int requested = system.ioctl(descriptor, VIDIOC_REQBUFS, &request);
  if (requested == -EBUSY) return busy(path);
  if (requested >= 0) {
    request.count = 0;
    system.ioctl(descriptor, VIDIOC_REQBUFS, &request);
  }
  return "OpenCV cannot read its pixel format '" + four_characters(format.fmt.pix.pixelformat) +
         "'; a camera at the CSI port of a Raspberry Pi needs `libcamerify` before the command";
}

}  // namespace

std::string video4linux_fault(System& system, const std::string& path) {
  const int opened = system.open(path, true);
  if (opened < 0) return open_fault(path, -opened);
  const Descriptor descriptor(system, opened);
  std::string fault = capability_fault(system, descriptor.number());
  if (fault.empty()) fault = capture_fault(system, descriptor.number(), path);
  if (fault.empty()) {
    fault = "OpenCV gets no images from it; `v4l2-ctl -d " + path + " --all` shows its formats";
  }
  return fault;
}

}  // namespace tether::devices
