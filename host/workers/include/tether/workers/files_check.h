#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace tether::workers {

/// The digest of each file, by its path.
std::map<std::string, std::string> digests_of(const std::vector<std::filesystem::path>& files);

/// Checks that this machine has the files on which results depend, as they were.
/// @throws Error(kBadFile) about the first file that is missing or has another digest.
void require_same_files(const std::map<std::string, std::string>& digests);

}  // namespace tether::workers
