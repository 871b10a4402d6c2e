#include "camera/camera_files.h"

#include "real.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <string_view>
#include <utility>

#include <fcntl.h>
#include <sys/eventfd.h>
#include <unistd.h>

namespace tether::as_is {

std::optional<unsigned> CameraFiles::number_of(const char* path) {
  constexpr std::string_view kPrefix = "/dev/video";
  const std::string_view whole = path == nullptr ? "" : path;
  if (!whole.starts_with(kPrefix)) return std::nullopt;
  const std::string_view digits = whole.substr(kPrefix.size());
  unsigned number = 0;
  const auto [end, error] = std::from_chars(digits.begin(), digits.end(), number);
  return error == std::errc() && end == digits.end() ? std::optional(number) : std::nullopt;
}

void CameraFiles::add(const uav::SensorDescription& sensor, Camera::Images images) {
  const auto number = static_cast<unsigned>(cameras_.size());
  cameras_.emplace_back(sensor, number, std::move(images));
}

int CameraFiles::open(unsigned number, int flags) {
  const auto fail = [](int error) {
    errno = error;
    return -1;
  };
  if (number >= cameras_.size()) return fail(ENOENT);
  const int fd = ::eventfd(0, EFD_SEMAPHORE | ((flags & O_CLOEXEC) != 0 ? EFD_CLOEXEC : 0) |
                                  ((flags & O_NONBLOCK) != 0 ? EFD_NONBLOCK : 0));
  if (fd < 0) return -1;
  const int signal = TETHER_REAL(fcntl64)(fd, F_DUPFD_CLOEXEC, 0);
  auto file = std::ranges::find(files_, 0, &File::descriptors);
  if (file == files_.end()) file = files_.emplace(files_.end());
  if (fd >= kMost || signal < 0 || files_.size() > UINT16_MAX) {
    TETHER_REAL(close)(fd);
    if (signal >= 0) TETHER_REAL(close)(signal);
    return fail(EMFILE);
  }
  *file = {number, 1, {signal}};
  ++open_;
  set(fd, static_cast<std::uint16_t>(file - files_.begin() + 1));
  return fd;
}

int CameraFiles::answer(int fd, unsigned long request, void* argument) {
  const File& file = files_[file_of(fd) - 1U];
  return cameras_[file.number].answer(file.opener, request, argument);
}

void CameraFiles::copy(int fd, int copy) {
  if (copy < 0 || copy >= kMost) return;
  const std::uint16_t file = file_of(fd);
  ++files_[file - 1U].descriptors;
  set(copy, file);
}

void CameraFiles::forget(int fd) {
  File& file = files_[file_of(fd) - 1U];
  set(fd, 0);
  if (--file.descriptors > 0) return;
  --open_;
  cameras_[file.number].close(file.opener);
  TETHER_REAL(close)(file.opener.signal);
}

}  // namespace tether::as_is
