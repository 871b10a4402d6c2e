#include "system.h"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace tether::devices {
namespace {

class RealSystem final : public System {
 public:
  int stat(const std::string& path, FileKind& kind) override;
  int open(const std::string& path, bool writable) override;
  void close(int descriptor) override { ::close(descriptor); }
  long read_again(int descriptor, char* buffer, std::size_t size) override {
    const ssize_t count = ::pread(descriptor, buffer, size, 0);
    return count < 0 ? -errno : static_cast<long>(count);
  }
  int ioctl(int descriptor, unsigned long request, void* argument) override {
    const int result = ::ioctl(descriptor, request, argument);
    return result < 0 ? -errno : result;
  }
  std::vector<std::string> list(const std::string& folder) override;
};

int RealSystem::stat(const std::string& path, FileKind& kind) {
  struct stat found {};
  if (::stat(path.c_str(), &found) != 0) return -errno;
  kind = S_ISREG(found.st_mode)   ? FileKind::kRegular
         : S_ISDIR(found.st_mode) ? FileKind::kFolder
         : S_ISCHR(found.st_mode) ? FileKind::kCharacterDevice
                                  : FileKind::kOther;
  return 0;
}

int RealSystem::open(const std::string& path, bool writable) {
  const int access = writable ? O_RDWR : O_RDONLY;
  const int descriptor = ::open(path.c_str(), access | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  return descriptor < 0 ? -errno : descriptor;
}

std::vector<std::string> RealSystem::list(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code error;
  std::filesystem::directory_iterator it(folder, error);
  for (; !error && it != std::filesystem::directory_iterator(); it.increment(error)) {
    names.push_back(it->path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace

System& real_system() {
  static RealSystem system;
  return system;
}

Descriptor::Descriptor(Descriptor&& other) noexcept
    : system_(other.system_), number_(std::exchange(other.number_, -1)) {}

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  close();
  system_ = other.system_;
  number_ = std::exchange(other.number_, -1);
  return *this;
}

void Descriptor::close() {
  if (number_ >= 0) system_->close(number_);
  number_ = -1;
}

std::string error_text(int error) {
  return std::generic_category().message(error);
}

}  // namespace tether::devices
