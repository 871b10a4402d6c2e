#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <tether/os/file_descriptor.h>

namespace tether::os {

/// A file in memory, which is gone when its process ends. Child processes do not inherit it.
class MemoryFile {
 public:
  /// With this content, positioned at its beginning. @throws Error(kSetup).
  explicit MemoryFile(std::string_view content = {});

  int descriptor() const { return descriptor_.get(); }
  /// Valid within this process.
  std::filesystem::path path() const;
  /// Its whole current content.
  std::string content() const;

 private:
  FileDescriptor descriptor_;
};

}  // namespace tether::os
