#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace tether::record {

/// A file written from front to back, each write handed to the system at once, so that it
/// survives a killed process. Counts and sums (CRC-32) the bytes. When a write fails (a full disk),
/// the file is cut back to what was whole; nothing is written after a failure.
/// @throws Error(kSetup) with the file if it cannot be created or written.
class OutputFile {
 public:
  explicit OutputFile(std::filesystem::path path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void write(std::string_view bytes);
  /// Everything so far can be read without what follows: a later failure leaves it.
  void end_part() { whole_ = position_; }
  /// Writes what may come next, so that it is there if the process is killed; it is not counted,
  /// and the next call of either kind overwrites it.
  void write_ahead(std::string_view bytes);
  /// Flushes to the disk, so that the file survives a power cut as well, and reports errors that
  /// only this or closing shows (a full network disk). Later calls do nothing.
  void close();

  std::uint64_t position() const { return position_; }
  std::uint32_t crc() const { return crc_; }
  bool failed() const { return error_ != 0; }

 private:
  void write_at(std::uint64_t position, std::string_view bytes);
  [[noreturn]] void fail(const char* what, int error_number);

  std::filesystem::path path_;
  int descriptor_ = -1;
  std::uint64_t position_ = 0;
  std::uint64_t whole_ = 0;  ///< end of the last part
  std::uint64_t end_ = 0;    ///< of the file, with what was written ahead
  std::uint32_t crc_ = 0;
  int error_ = 0;  ///< of the first failure
};

}  // namespace tether::record
