#pragma once

#include <filesystem>
#include <string>

namespace tether::os {

/// A new folder that only this user can enter, removed with the object, and by an Interrupt that
/// ends the process.
class TemporaryFolder {
 public:
  /// Its name is `prefix` and six characters. @throws Error(kSetup) if it cannot be made.
  explicit TemporaryFolder(const std::string& prefix);
  TemporaryFolder(const std::string& prefix, const std::filesystem::path& parent);
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// The path of a name in the folder.
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

/// Removes the folders of all objects that live and ends the process at once, without destructors.
/// Thread-safe: no thread makes another folder meanwhile.
[[noreturn]] void end_without_temporary_folders(int exit_code);

}  // namespace tether::os
