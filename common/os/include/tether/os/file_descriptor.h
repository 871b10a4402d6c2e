#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

namespace tether::os {

/// Owns a file descriptor.
class FileDescriptor {
 public:
  FileDescriptor() = default;
  explicit FileDescriptor(int descriptor) : descriptor_(descriptor) {}
  FileDescriptor(FileDescriptor&& other) noexcept
      : descriptor_(std::exchange(other.descriptor_, -1)) {}
  FileDescriptor& operator=(FileDescriptor&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    return *this;
  }
  ~FileDescriptor();

  /// −1 if it owns none.
  int get() const { return descriptor_; }
  explicit operator bool() const { return descriptor_ >= 0; }

 private:
  int descriptor_ = -1;
};

/// Both ends of a pipe. Child processes do not inherit them.
struct Pipe {
  FileDescriptor read_end;
  FileDescriptor write_end;
};

/// Both ends are empty, and errno has the reason, if the system refuses.
Pipe make_pipe();

/// Writes the whole text; blocks while the reader is slow. @return false if the write failed.
bool write_all(const FileDescriptor& to, std::string_view text);

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
