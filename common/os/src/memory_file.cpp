#include <cerrno>

#include <sys/mman.h>
#include <unistd.h>

#include <tether/base/error.h>
#include <tether/os/file_descriptor.h>
#include <tether/os/text_file.h>

namespace tether::os {

MemoryFile::MemoryFile(std::string_view content)
    : descriptor_(memfd_create("tether", MFD_CLOEXEC)) {
  if (!descriptor_ || !write_all(descriptor_, content) ||
      lseek(descriptor_.get(), 0, SEEK_SET) != 0)
    throw Error(ErrorCode::kSetup, "cannot create a file in memory: " + reason_of(errno));
}

std::filesystem::path MemoryFile::path() const {
  return "/proc/self/fd/" + std::to_string(descriptor_.get());
}

std::string MemoryFile::content() const {
  return read_whole(path());
}

}  // namespace tether::os
