#include <tether/base/error.h>
#include <tether/os/text_file.h>
#include <tether/workers/files_check.h>

namespace tether::workers {

std::map<std::string, std::string> digests_of(const std::vector<std::filesystem::path>& files) {
  std::map<std::string, std::string> digests;
  for (const auto& file : files)
    if (!digests.contains(file.string())) digests[file.string()] = os::digest_of_file(file);
  return digests;
}

void require_same_files(const std::map<std::string, std::string>& digests) {
  for (const auto& [file, digest] : digests) {
    const bool exists = std::filesystem::exists(file);
    if (exists && os::digest_of_file(file) == digest) continue;
    throw Error(ErrorCode::kBadFile, {file},
                std::string(exists ? "is not the file with which the campaign was started"
                                   : "does not exist on this machine") +
                    ". All machines need the same files at the same paths.")
        .about(file);
  }
}

}  // namespace tether::workers
