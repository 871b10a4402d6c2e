#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace tether::os {

/// Suffix of a file that is being written, or was when the process or the machine stopped.
inline constexpr std::string_view kPartSuffix = ".part";

/// A name from a record or a peer as part of a file's name: '/' and control characters become '_',
/// so that it cannot lead out of the folder or control a terminal.
std::string file_name_of(std::string_view name);

/// Replaces the content of `path` by `text`, completely or not at all: writes a file in the same
/// folder, flushes it to the disk, renames it. Of a symbolic link, the file behind it is replaced.
/// A pipe or a device is written to directly.
/// @throws Error(kSetup) with the file's place if the file system refuses; the old content stays.
void write_file_atomically(const std::filesystem::path& path, std::string_view text);

/// Why a path that is not a regular file is none: it is missing or cannot be reached, or is a
/// folder, a pipe or a device.
std::string why_no_file(const std::filesystem::path& path);

/// The content of a regular file; reading a pipe or a device might never end.
/// @throws Error(kBadFile) if it is missing, unreadable or longer than `limit` bytes.
std::string read_file(const std::filesystem::path& file, std::uintmax_t limit = UINTMAX_MAX);

/// The first bytes of a regular file, at most so many; empty if it cannot be read.
std::string begin_of(const std::filesystem::path& file, std::size_t most_bytes);
/// The content of a file of any kind; empty if it is missing.
std::string read_whole(const std::filesystem::path& file);
/// The last line that is not blank, without blanks at its ends; empty if there is none.
std::string last_line(const std::string& text);

/// A 64-bit FNV-1a digest as 16 hexadecimal digits. It distinguishes versions; it is not
/// cryptographic. Thread-safe.
std::string digest_of(std::string_view text);
/// The digest of the content. Thread-safe. The file is read again only after it changed: the digest
/// is remembered while the file's number, size and times of change stay the same, once these times
/// are older than the coarsest clock of a file system.
/// @throws Error(kBadFile) as `read_file`.
std::string digest_of_file(const std::filesystem::path& file);

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
