#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace tether::record {

/// A file written from front to back, each write handed to the system at once, so that it
/// survives a killed process. Counts and sums (CRC-32) the bytes.
/// @throws Error(kSetup) with the file if it cannot be created or written; nothing is written
/// after a failure.
class OutputFile {
 public:
  explicit OutputFile(std::filesystem::path path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void write(std::string_view bytes);
  /// Flushes to the disk, so that the file survives a power cut as well, and reports errors that
  /// only this or closing shows (a full network disk). Later calls do nothing.
  void close();

  std::uint64_t position() const { return position_; }
  std::uint32_t crc() const { return crc_; }
  bool failed() const { return failed_; }

 private:
  [[noreturn]] void fail(const char* what, int error_number);

  std::filesystem::path path_;
  int descriptor_ = -1;
  std::uint64_t position_ = 0;
  std::uint32_t crc_ = 0;
  bool failed_ = false;
};

}  // namespace tether::record
