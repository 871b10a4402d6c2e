// Devices in place of the C library's files: /dev/video0, … are the cameras of the UAV, and there
// are no others; usual serial ports lead to its flight controller, if it has one, or to its
// receiver of satellite navigation.

#include "clocks.h"
#include "in_place.h"
#include "serial.h"

#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

#include <fcntl.h>
#include <linux/videodev2.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/sysmacros.h>
#include <unistd.h>

namespace tether::as_is {
namespace {

// The kernel's numbers of their drivers.
constexpr unsigned kVideoDevices = 81, kSerialDevices = 166;

/// The number of a camera's path; none: it is another file, or the process is not under test.
std::optional<unsigned> camera_at(const char* path) {
  const auto number = CameraFiles::number_of(path);
  return number && agent() != nullptr ? number : std::nullopt;
}

int fail(int error) {
  errno = error;
  return -1;
}

int open_camera(unsigned number, int flags) {
  const Inside inside;
  Agent& agent = *Agent::get();
  if (!agent.has_camera(number))
    Agent::tell("the program looked for /dev/video" + std::to_string(number) +
                "; the UAV has no such camera that measures periodically and in colour");
  return agent.with_cameras([=](CameraFiles& files) { return files.open(number, flags); });
}

/// What the path of a serial port leads to; none: nothing of the UAV.
std::optional<Port::Line> line_at(const char* path) {
  if (is_serial_port(path) && agent() != nullptr && Agent::get()->has_controller())
    return Port::Line::kController;
  if (!is_receiver_port(path) || agent() == nullptr) return std::nullopt;
  if (Agent::get()->has_receiver()) return Port::Line::kReceiver;
  const Inside inside;
  Agent::tell(std::string("the program looked for ") + path +
              "; the UAV has no sensor for satellite navigation that measures periodically");
  return std::nullopt;
}

bool is_uptime(const char* path) {
  return path != nullptr && std::string_view(path) == "/proc/uptime" && agent() != nullptr;
}

/// As it is now: programs open it for each look.
int open_uptime() {
  const Inside inside;
  const timespec up = shown(CLOCK_BOOTTIME, Agent::get()->now());
  const int file = ::memfd_create("uptime", MFD_CLOEXEC);
  constexpr long kNsPerHundredth = 10'000'000;
  if (file >= 0)
    ::dprintf(file, "%ld.%02ld 0.00\n", static_cast<long>(up.tv_sec), up.tv_nsec / kNsPerHundredth);
  if (file >= 0) ::lseek(file, 0, SEEK_SET);
  return file;
}

/// A descriptor of the device, −1 with errno; none: the path is another file's.
std::optional<int> open_device(const char* path, int flags) {
  if (is_uptime(path)) return open_uptime();
  if (const auto number = camera_at(path)) return open_camera(*number, flags);
  const auto line = line_at(path);
  if (!line) return std::nullopt;
  const Inside inside;
  return Agent::get()->port().open_serial(*line, flags);
}

/// Whether the path is that of a device. `result`: whether that is there.
bool look_for(const char* path, int& result) {
  result = 0;
  if (line_at(path)) return true;
  const auto number = camera_at(path);
  if (number && !Agent::get()->has_camera(*number)) result = fail(ENOENT);
  return number.has_value();
}

template <class Stat>
int describe(unsigned driver, unsigned number, Stat* out) {
  *out = {};
  out->st_mode = S_IFCHR | 0660;
  out->st_nlink = 1;
  out->st_rdev = makedev(driver, number);
  return 0;
}

template <class Stat, class Real>
int stat_path(const char* path, Stat* out, Real real) {
  int result = 0;
  if (!look_for(path, result)) return real();
  if (result != 0) return result;
  const auto camera = CameraFiles::number_of(path);
  return describe(camera ? kVideoDevices : kSerialDevices, camera.value_or(0), out);
}

template <class Stat, class Real>
int stat_descriptor(int fd, Stat* out, Real real) {
  Agent* const agent = tether::as_is::agent();
  if (agent == nullptr || !agent->is_camera(fd)) return real();
  const Inside inside;
  const unsigned number =
      agent->with_cameras([fd](CameraFiles& files) { return files.number(fd); });
  return describe(kVideoDevices, number, out);
}

/// An image that is there, or will be.
int dequeue(Agent& agent, int fd, void* argument) {
  const auto answer = [&] {
    return agent.with_cameras(
        [=](CameraFiles& files) { return files.answer(fd, VIDIOC_DQBUF, argument); });
  };
  int result = answer();
  if (result != EAGAIN) return result;
  if ((::fcntl(fd, F_GETFL) & O_NONBLOCK) != 0) {
    agent.take_arrived();
    return answer();
  }
  const auto end = agent.wait(
      std::nullopt, [&] { return (result = answer()) != EAGAIN; },
      [fd](Duration slice, int wake) {
        pollfd fds[] = {{fd, POLLIN, 0}, {wake, POLLIN, 0}};
        const timespec time = to_timespec(slice);
        TETHER_REAL(ppoll)(fds, 2, &time, nullptr);
      });
  if (end == Agent::End::kHandler) return EINTR;
  return result;
}

int control(Agent& agent, int fd, unsigned long request, void* argument) {
  const int kept = errno;
  const Inside inside;
  const int result = static_cast<std::uint32_t>(request) == VIDIOC_DQBUF
                         ? dequeue(agent, fd, argument)
                         : agent.with_cameras([=](CameraFiles& files) {
                             return files.answer(fd, request, argument);
                           });
  errno = result == 0 ? kept : result;
  return result == 0 ? 0 : -1;
}

/// The memory of the buffers, and whether the program may map that much of it.
int memory_for(Agent& agent, int fd, std::size_t size, int flags, off_t offset) {
  const Inside inside;
  return agent.with_cameras([=](CameraFiles& files) {
    const Camera& camera = files.camera(fd);
    const bool is_within = offset >= 0 && camera.memory() >= 0 &&
                           static_cast<std::size_t>(offset) + size <= camera.memory_bytes();
    return is_within && (flags & MAP_SHARED) != 0 ? camera.memory() : -1;
  });
}

}  // namespace
}  // namespace tether::as_is

using namespace tether::as_is;

// The mode, which is only given for files that may be made.
#define TETHER_OPEN_MODE(flags)                                     \
  mode_t mode = 0;                                                  \
  if (((flags)&O_CREAT) != 0 || ((flags)&O_TMPFILE) == O_TMPFILE) { \
    va_list list;                                                   \
    va_start(list, flags);                                          \
    mode = va_arg(list, mode_t);                                    \
    va_end(list);                                                   \
  }                                                                 \
  static_cast<void>(0)

TETHER_IN_PLACE int open(const char* path, int flags, ...) {
  TETHER_OPEN_MODE(flags);
  if (const auto opened = open_device(path, flags)) return *opened;
  return TETHER_REAL(open)(path, flags, mode);
}

TETHER_IN_PLACE int open64(const char* path, int flags, ...) {
  TETHER_OPEN_MODE(flags);
  if (const auto opened = open_device(path, flags)) return *opened;
  return TETHER_REAL(open64)(path, flags, mode);
}

TETHER_IN_PLACE int openat(int folder, const char* path, int flags, ...) {
  TETHER_OPEN_MODE(flags);
  if (const auto opened = open_device(path, flags)) return *opened;
  return TETHER_REAL(openat)(folder, path, flags, mode);
}

TETHER_IN_PLACE int openat64(int folder, const char* path, int flags, ...) {
  TETHER_OPEN_MODE(flags);
  if (const auto opened = open_device(path, flags)) return *opened;
  return TETHER_REAL(openat64)(folder, path, flags, mode);
}

TETHER_IN_PLACE int __open_2(const char* path, int flags) {
  return open(path, flags);
}
TETHER_IN_PLACE int __open64_2(const char* path, int flags) {
  return open64(path, flags);
}
TETHER_IN_PLACE int __openat_2(int folder, const char* path, int flags) {
  return openat(folder, path, flags);
}
TETHER_IN_PLACE int __openat64_2(int folder, const char* path, int flags) {
  return openat64(folder, path, flags);
}

TETHER_IN_PLACE int stat(const char* __restrict path, struct stat* __restrict out) {
  return stat_path(path, out, [=] { return TETHER_REAL(stat)(path, out); });
}
TETHER_IN_PLACE int stat64(const char* __restrict path, struct stat64* __restrict out) {
  return stat_path(path, out, [=] { return TETHER_REAL(stat64)(path, out); });
}
TETHER_IN_PLACE int lstat(const char* __restrict path, struct stat* __restrict out) {
  return stat_path(path, out, [=] { return TETHER_REAL(lstat)(path, out); });
}
TETHER_IN_PLACE int lstat64(const char* __restrict path, struct stat64* __restrict out) {
  return stat_path(path, out, [=] { return TETHER_REAL(lstat64)(path, out); });
}
TETHER_IN_PLACE int fstatat(int folder, const char* __restrict path, struct stat* __restrict out,
                            int flags) {
  return stat_path(path, out, [=] { return TETHER_REAL(fstatat)(folder, path, out, flags); });
}
TETHER_IN_PLACE int fstatat64(int folder, const char* __restrict path,
                              struct stat64* __restrict out, int flags) {
  return stat_path(path, out, [=] { return TETHER_REAL(fstatat64)(folder, path, out, flags); });
}
TETHER_IN_PLACE int fstat(int fd, struct stat* out) {
  return stat_descriptor(fd, out, [=] { return TETHER_REAL(fstat)(fd, out); });
}
TETHER_IN_PLACE int fstat64(int fd, struct stat64* out) {
  return stat_descriptor(fd, out, [=] { return TETHER_REAL(fstat64)(fd, out); });
}

TETHER_IN_PLACE int access(const char* path, int mode) {
  int result = 0;
  return look_for(path, result) ? result : TETHER_REAL(access)(path, mode);
}
TETHER_IN_PLACE int faccessat(int folder, const char* path, int mode, int flags) {
  int result = 0;
  return look_for(path, result) ? result : TETHER_REAL(faccessat)(folder, path, mode, flags);
}

TETHER_IN_PLACE int ioctl(int fd, unsigned long request, ...) {
  va_list list;
  va_start(list, request);
  void* const argument = va_arg(list, void*);
  va_end(list);
  Agent* const agent = tether::as_is::agent();
  if (agent == nullptr || !agent->is_camera(fd)) return TETHER_REAL(ioctl)(fd, request, argument);
  return control(*agent, fd, request, argument);
}

TETHER_IN_PLACE void* mmap(void* at, size_t size, int protection, int flags, int fd, off_t offset) {
  Agent* const agent = tether::as_is::agent();
  if (agent == nullptr || !agent->is_camera(fd))
    return TETHER_REAL(mmap)(at, size, protection, flags, fd, offset);
  const int memory = memory_for(*agent, fd, size, flags, offset);
  if (memory >= 0) return TETHER_REAL(mmap)(at, size, protection, flags, memory, offset);
  errno = EINVAL;
  return MAP_FAILED;
}
TETHER_IN_PLACE void* mmap64(void* at, size_t size, int protection, int flags, int fd,
                             off64_t offset) {
  return mmap(at, size, protection, flags, fd, offset);
}

// v4l2-ctl looks there for what kind of device it is.
TETHER_IN_PLACE FILE* fopen(const char* __restrict path, const char* __restrict mode) {
  unsigned number = 0;
  if (is_uptime(path)) return ::fdopen(open_uptime(), mode);
  if (agent() == nullptr || std::sscanf(path, "/sys/dev/char/81:%u/uevent", &number) != 1 ||
      !Agent::get()->has_camera(number))
    return TETHER_REAL(fopen)(path, mode);
  const std::string text = "MAJOR=81\nMINOR=" + std::to_string(number) + "\nDEVNAME=video" +
                           std::to_string(number) + "\n";
  const int file = ::memfd_create("uevent", MFD_CLOEXEC);
  if (file < 0 || ::pwrite(file, text.data(), text.size(), 0) < 0) return nullptr;
  return ::fdopen(file, mode);
}
TETHER_IN_PLACE FILE* fopen64(const char* __restrict path, const char* __restrict mode) {
  return fopen(path, mode);
}

// libv4l2 goes around the C library.
std::optional<long> tether::as_is::device_call(long number, const long (&a)[6]) {
  const auto pointer = [](long argument) {
    void* out = nullptr;
    std::memcpy(&out, &argument, sizeof out);
    return out;
  };
  const int fd = static_cast<int>(a[number == SYS_mmap ? 4 : 0]);
  if (number == SYS_openat) {
    const auto* const path = static_cast<const char*>(pointer(a[1]));
    if (const auto opened = open_device(path, static_cast<int>(a[2]))) return *opened;
  }
  if (agent() == nullptr || !Agent::get()->is_camera(fd)) return std::nullopt;
  if (number == SYS_ioctl) return ioctl(fd, static_cast<unsigned long>(a[1]), pointer(a[2]));
  if (number == SYS_close) return close(fd);
  if (number != SYS_mmap) return std::nullopt;
  const void* const mapped = mmap(pointer(a[0]), static_cast<std::size_t>(a[1]),
                                  static_cast<int>(a[2]), static_cast<int>(a[3]), fd, a[5]);
  long result = 0;
  std::memcpy(&result, &mapped, sizeof result);
  return result;
}
