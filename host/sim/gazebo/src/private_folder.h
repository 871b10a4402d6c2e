#pragma once

#include <filesystem>
#include <string>

namespace tether::sim {

/// A folder for what a run needs only while it lasts: this user's alone (mode 0700), with a short
/// path, so that it may hold sockets. It is removed with the object. One whose process was killed
/// is removed by the next process of this user that makes one. Not thread-safe.
class PrivateFolder {
 public:
  /// "/tmp/<prefix>XXXXXX". @throws Error(kSetup) when it cannot be made.
  explicit PrivateFolder(const std::string& prefix);
  ~PrivateFolder();
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  int lock_ = -1;  // of the folder, held while its owner lives
};

}  // namespace tether::sim
