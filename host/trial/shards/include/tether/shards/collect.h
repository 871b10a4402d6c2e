#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace tether::shards {

struct Collected {
  std::size_t brought = 0;               ///< results that are new in the first folder
  std::vector<std::string> differing{};  ///< results of one trial that differ; one line each
  std::vector<std::string> left_out{};   ///< folders that are not of this campaign; one line each
  std::vector<std::filesystem::path> missing{};  ///< trials without a result, relative
  std::size_t planned = 0;
};

/// Brings the results of all folders of a campaign together in the first one, which is made if it
/// does not exist. The others stay as they are. A folder with another campaign, other trials, files
/// or versions is left out. Of several results of one trial, the first one counts; the others are
/// listed if they differ in more than what each run has of its own (times of the host, names).
/// @pre folders is not empty.
/// @throws Error(kUsage) about a folder that has no campaign; Error(kSetup) as hand_in.
Collected collect(const std::vector<std::filesystem::path>& folders);

/// Copies the folder of a flown trial into the campaign's folder, where it appears as a whole. What
/// is there stays if it has a result that counts; a failed set-up is replaced. Several processes on
/// any machines may do this at once (the folder may be shared, for instance over NFS): one wins.
/// @param flown anywhere. @param trial relative to `campaign`.
/// @returns whether it is there now; false if another result was.
/// @throws Error(kSetup) with the path if the file system refuses; nothing is left of the copy.
bool hand_in(const std::filesystem::path& flown, const std::filesystem::path& campaign,
             const std::filesystem::path& trial);

}  // namespace tether::shards
