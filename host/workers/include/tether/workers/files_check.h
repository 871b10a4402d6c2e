#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace tether::workers {

/// Checks that this machine has the files on which results depend, and that they stay as they are.
/// Their content is read again only if size, time or inode have changed. Not thread-safe.
class FilesCheck {
 public:
  /// @throws as `require_unchanged`.
  explicit FilesCheck(const std::map<std::string, std::string>& digests);
  /// @throws Error(kBadFile) about the first file that is missing or has another digest.
  void require_unchanged();

 private:
  struct Seen {
    std::filesystem::path file;
    std::string digest;
    std::array<std::uint64_t, 5> status{};  ///< what changes with the content
  };
  std::vector<Seen> files_;
};

/// The digest of each file, by its path.
std::map<std::string, std::string> digests_of(const std::vector<std::filesystem::path>& files);

}  // namespace tether::workers
