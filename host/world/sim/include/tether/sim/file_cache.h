#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

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

  /// An entry, as long as it lives, whatever becomes of its file. Begins at a multiple of 64 bytes.
  using Content = std::shared_ptr<const std::string_view>;
  /// The entry of the key; it has been used now. Null: there is none, or it is damaged.
  Content find(std::string_view key) const;

  /// Keeps the parts, one after the other. The first `checked` ones are compared with their
  /// checksum when the entry is found; of the others, only the size is checked.
  void keep(std::string_view key, std::span<const std::string_view> parts,
            std::size_t checked) const;
  void keep(std::string_view key, std::string_view content) const { keep(key, {&content, 1}, 1); }

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

/// What distinguishes this program, with its libraries, from others and from itself after a change.
const std::string& identity_of_program();

}  // namespace tether::sim
