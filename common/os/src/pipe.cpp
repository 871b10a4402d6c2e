#include <cerrno>
#include <cstddef>

#include <fcntl.h>
#include <unistd.h>

#include <tether/os/file_descriptor.h>

namespace tether::os {

Pipe make_pipe() {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return {};
  return {FileDescriptor(ends[0]), FileDescriptor(ends[1])};
}

bool write_all(const FileDescriptor& to, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = write(to.get(), text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

}  // namespace tether::os
