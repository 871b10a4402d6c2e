#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <tether/os/file_descriptor.h>

namespace tether::os {

/// A file in memory: a killed process leaves nothing of it. Not inherited by programs that are
/// started meanwhile.
class MemoryFile {
 public:
  /// With that content, to be read from its beginning. @throws Error(kSetup).
  explicit MemoryFile(std::string_view content = {});

  int descriptor() const { return descriptor_.get(); }
  /// For whoever is in this process.
  std::filesystem::path path() const;
  /// All that is in it now.
  std::string content() const;

 private:
  FileDescriptor descriptor_;
};

}  // namespace tether::os
