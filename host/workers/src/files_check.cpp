#include <sys/stat.h>

#include <tether/base/error.h>
#include <tether/os/text_file.h>
#include <tether/workers/files_check.h>

namespace tether::workers {
namespace {

/// All zero: there is no such file.
std::array<std::uint64_t, 5> status_of(const std::filesystem::path& file) {
  struct stat now {};
  if (::stat(file.c_str(), &now) != 0) return {};
  return {static_cast<std::uint64_t>(now.st_size), now.st_ino, now.st_dev,
          static_cast<std::uint64_t>(now.st_mtim.tv_sec),
          static_cast<std::uint64_t>(now.st_mtim.tv_nsec)};
}

}  // namespace

FilesCheck::FilesCheck(const std::map<std::string, std::string>& digests) {
  for (const auto& [file, digest] : digests) files_.push_back({file, digest, {}});
  require_unchanged();
}

void FilesCheck::require_unchanged() {
  for (Seen& seen : files_) {
    const auto now = status_of(seen.file);
    const bool exists = now != std::array<std::uint64_t, 5>{};
    if (exists && now == seen.status) continue;
    if (exists && os::digest_of_file(seen.file) == seen.digest) {
      seen.status = now;
      continue;
    }
    throw Error(ErrorCode::kBadFile, {seen.file.string()},
                std::string(exists ? "is not the file with which the campaign was started"
                                   : "does not exist on this machine") +
                    ". All machines need the same files at the same paths.")
        .about(seen.file.string());
  }
}

std::map<std::string, std::string> digests_of(const std::vector<std::filesystem::path>& files) {
  std::map<std::string, std::string> digests;
  for (const auto& file : files)
    if (!digests.contains(file.string())) digests[file.string()] = os::digest_of_file(file);
  return digests;
}

}  // namespace tether::workers
