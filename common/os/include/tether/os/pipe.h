#pragma once

#include <string_view>

#include <tether/os/file_descriptor.h>

namespace tether::os {

/// Both ends of a pipe. Child processes do not inherit them.
struct Pipe {
  FileDescriptor read_end;
  FileDescriptor write_end;
};

/// Both ends are empty, and errno has the reason, if the system refuses.
Pipe make_pipe();

/// Writes the whole text; blocks while the reader is slow. @return false if the write failed.
bool write_all(const FileDescriptor& to, std::string_view text);

}  // namespace tether::os
