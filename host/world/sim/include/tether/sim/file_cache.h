#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <tether/base/time.h>

namespace tether::sim {

/// What was computed from files, kept in a folder for the next process that computes the same.
/// Nothing depends on it: what cannot be read is not there, what cannot be written is not kept.
/// Any number of threads and processes may use one folder: an entry appears as a whole.
class FileCache {
 public:
  static constexpr std::uintmax_t kMostBytes = 1'000'000'000;

  /// Removes the entries that were not used for longest, so that all have at most `most_bytes`.
  explicit FileCache(std::filesystem::path folder, std::uintmax_t most_bytes = kMostBytes)
      : folder_(std::move(folder)), most_bytes_(most_bytes) {}

  /// $TETHER_CACHE, else "tether" in $XDG_CACHE_HOME or ~/.cache. None: $TETHER_CACHE is "off", or
  /// there is no home.
  static std::optional<FileCache> of_user();

  /// The parts of an entry, as long as it lives, whatever becomes of its file. Each begins at a
  /// multiple of 64 bytes.
  using Parts = std::shared_ptr<const std::vector<std::string_view>>;
  /// The entry of the key; it has been used now. Null: there is none, or it is damaged.
  Parts find(std::string_view key) const;

  /// When the entry is found, the first `checked` parts are compared with their checksum; of the
  /// others, only the size is checked.
  void keep(std::string_view key, std::span<const std::string_view> parts,
            std::size_t checked) const;
  void keep(std::string_view key, std::string_view part) const { keep(key, {&part, 1}, 1); }

  struct Size {
    std::size_t entries = 0;
    std::uintmax_t bytes = 0;
  };
  Size size() const;
  /// Removes all entries. @throws Error(kSetup) if the file system refuses.
  void clear() const;
  /// @throws Error(kSetup) with the reason if entries cannot be kept.
  void require_writable() const;

  const std::filesystem::path& folder() const { return folder_; }
  std::uintmax_t most_bytes() const { return most_bytes_; }

 private:
  std::filesystem::path file_of(std::string_view key) const;
  void remove_oldest() const;

  std::filesystem::path folder_;
  std::uintmax_t most_bytes_;
};

/// What changes with a file, or with the entries of a folder: its kind, inode, size, and the times
/// of the last change of its content and of its status [ns]. Of nothing, zeros.
using FileState = std::array<std::int64_t, 5>;
/// Of a folder whose entries do not matter, only the kind.
FileState state_of(const std::filesystem::path& path, bool with_entries = false);
/// Whether the last change was longer ago than `age`.
bool is_older(const FileState& state, Duration age);
/// A file that changed less than this ago can change again without another time.
inline constexpr Duration kFileTick = std::chrono::seconds(2);

/// What distinguishes this program, with its libraries, from others and from itself after a change.
const std::string& identity_of_program();

}  // namespace tether::sim
