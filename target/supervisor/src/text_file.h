#pragma once

#include <string>
#include <string_view>

#include <fcntl.h>
#include <unistd.h>

namespace tether::supervisor {

/// Writes to an existing file of the kernel; false if that fails. Allocates nothing, so that it can
/// be called between fork and exec.
inline bool write_file(const std::string& path, std::string_view text) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
  if (file < 0) return false;
  const bool written = ::write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  ::close(file);
  return written;
}

}  // namespace tether::supervisor
