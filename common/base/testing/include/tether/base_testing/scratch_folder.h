#pragma once

#include <filesystem>
#include <string>

/// For tests that need files.
namespace tether {

/// A new, empty folder of its own below the system's folder for temporary files. It is removed with
/// its object. If the running test has failed, it is kept and its path is printed to stderr.
/// Thread-safe.
class ScratchFolder {
 public:
  /// @throws std::runtime_error when it cannot be made.
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// The path of a name in the folder; it need not exist.
  std::filesystem::path path(const std::string& name) const { return path_ / name; }
  /// Writes the whole file, with the folders above it, and returns its path.
  /// @throws std::runtime_error when it cannot be written.
  std::filesystem::path write(const std::string& name, const std::string& text) const;

 private:
  std::filesystem::path path_;
};

}  // namespace tether
