#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// A folder that several machines share, for instance over NFS, and the only operations on it that
/// the protocol of workers uses. It relies on three properties, and on no lock (ADR 0051):
/// - open with O_CREAT | O_EXCL succeeds for one caller (NFS 3 and later);
/// - rename of a folder is atomic, and fails if the new name is a folder with content;
/// - what was written before a file was closed is seen by whoever opens it later.
/// A stale listing is allowed: it costs time, never a result.
namespace tether::workers {

/// Thread-safe. Paths are relative to the root. Every function throws Error(kSetup) with the path
/// if the file system refuses, unless it says otherwise.
class SharedFolder {
 public:
  explicit SharedFolder(std::filesystem::path root) : root_(std::move(root)) {}

  const std::filesystem::path& root() const { return root_; }

  /// Creates a file with this text; false, without a change, if there is one.
  bool create(const std::filesystem::path& file, std::string_view text) const;
  /// Replaces the text of a file as a whole. `writer` is unique to the caller.
  void replace(const std::filesystem::path& file, std::string_view text,
               const std::string& writer) const;
  /// None: there is no such file, or it cannot be read.
  std::optional<std::string> read(const std::filesystem::path& file) const;
  /// The names in a folder, sorted; empty if there is no such folder.
  std::vector<std::string> list(const std::filesystem::path& folder) const;
  /// Makes a folder and those above it.
  void make(const std::filesystem::path& folder) const;
  /// Gives a folder that was filled its final name; false if that has content already.
  bool rename(const std::filesystem::path& from, const std::filesystem::path& to) const;
  /// Removes a file or a folder with its content. Ignores errors.
  void remove(const std::filesystem::path& path) const;
  /// Copies the folder `local` to `staging`, flushes its files, and gives the copy its final name;
  /// false if there is a folder of that name with content. Removes what it copied unless it
  /// succeeds.
  bool publish(const std::filesystem::path& local, const std::filesystem::path& staging,
               const std::filesystem::path& target) const;

  /// The requests to the file system so far: each call that has a path, and each flush.
  std::uint64_t operations() const { return operations_; }

 private:
  std::filesystem::path path(const std::filesystem::path& relative) const;

  std::filesystem::path root_;
  mutable std::atomic<std::uint64_t> operations_ = 0;
};

}  // namespace tether::workers
