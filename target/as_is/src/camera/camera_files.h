#pragma once

#include "camera/camera.h"

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

namespace tether::as_is {

/// The program's descriptors of the UAV's cameras. Each is an eventfd, so that the kernel wakes
/// whoever waits for it by poll, select or epoll.
///
/// `is_any` and `is_ours` are thread-safe; of the others, one at a time.
class CameraFiles {
 public:
  /// The number of a device's path; none: it is no camera's.
  static std::optional<unsigned> number_of(const char* path);

  /// /dev/video of the next number.
  void add(const uav::SensorDescription& sensor, Camera::Images images);
  std::deque<Camera>& cameras() { return cameras_; }

  bool is_any() const { return open_ > 0; }
  bool is_ours(int fd) const { return fd >= 0 && fd < kMost && file_of(fd).load() != 0; }
  /// As open(); ENOENT: there is no such camera.
  int open(unsigned number, int flags);
  /// @pre is_ours(fd), as below
  unsigned number(int fd) const { return files_[file_of(fd) - 1U].number; }
  int answer(int fd, unsigned long request, void* argument);
  const Camera& camera(int fd) const { return cameras_[number(fd)]; }
  /// Another descriptor of the same.
  void copy(int fd, int copy);
  void forget(int fd);

 private:
  static constexpr int kMost = 4096;
  struct File {
    unsigned number = 0;
    int descriptors = 0;  // 0: closed
    Camera::Opener opener{};
  };
  const std::atomic<std::uint16_t>& file_of(int fd) const {
    return files_by_fd_[static_cast<std::size_t>(fd)];
  }
  void set(int fd, std::uint16_t file) { files_by_fd_[static_cast<std::size_t>(fd)] = file; }

  std::deque<Camera> cameras_;
  std::deque<File> files_;
  std::atomic<int> open_ = 0;  // files
  std::array<std::atomic<std::uint16_t>, kMost>
      files_by_fd_{};  // number in files_ + 1; 0: not ours
};

}  // namespace tether::as_is
