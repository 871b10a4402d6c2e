#include <tether/base/error.h>
#include <tether/os/text_file.h>
#include <tether/workers/files_check.h>

namespace tether::workers {
namespace {

bool is_same(const struct stat& a, const struct stat& b) {
  return a.st_size == b.st_size && a.st_ino == b.st_ino && a.st_dev == b.st_dev &&
         a.st_mtim.tv_sec == b.st_mtim.tv_sec && a.st_mtim.tv_nsec == b.st_mtim.tv_nsec;
}

}  // namespace

FilesCheck::FilesCheck(const std::map<std::string, std::string>& digests) {
  for (const auto& [file, digest] : digests) files_.push_back({file, digest, {}});
  require_unchanged();
}

void FilesCheck::require_unchanged() {
  for (Seen& seen : files_) {
    struct stat now {};
    const bool exists = ::stat(seen.file.c_str(), &now) == 0;
    if (exists && is_same(now, seen.status)) continue;
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
