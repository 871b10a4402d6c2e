#pragma once

#include <filesystem>
#include <string>

#include <tether/os/file_descriptor.h>

namespace tether::sim {

/// A folder for the temporary files of a run: for this user only (mode 0700), with a path that is
/// short enough for sockets. It is removed with the object. If a process is killed, the next
/// process of this user that makes a folder removes it. Not thread-safe.
class PrivateFolder {
 public:
  /// "/tmp/<prefix>XXXXXX". @throws Error(kSetup) if it cannot be made.
  explicit PrivateFolder(const std::string& prefix);
  ~PrivateFolder();
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  os::FileDescriptor lock_;  // of the folder, held while its owner lives
};

}  // namespace tether::sim
