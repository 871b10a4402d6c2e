#pragma once

#include <string_view>

#include <tether/os/file_descriptor.h>

namespace tether::os {

/// Both ends of a pipe. Programs that are started meanwhile do not inherit them.
struct Pipe {
  FileDescriptor read_end;
  FileDescriptor write_end;
};

/// Neither end is there, and errno says why, when the system refuses.
Pipe make_pipe();

/// Writes all of it, waiting for whoever reads. @return whether that was possible.
bool write_all(const FileDescriptor& to, std::string_view text);

}  // namespace tether::os
