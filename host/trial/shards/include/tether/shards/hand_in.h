#pragma once

#include <filesystem>

namespace tether::shards {

/// Copies the folder of a flown trial into the campaign's folder, where it appears as a whole. What
/// is there stays if it has a result that counts; a failed set-up is replaced. Several processes on
/// any machines may do this at once (the folder may be shared, for instance over NFS): one wins.
/// @param flown anywhere. @param trial relative to `campaign`.
/// @returns whether it is there now; false if another result was.
/// @throws Error(kSetup) with the path if the file system refuses; nothing is left of the copy.
bool hand_in(const std::filesystem::path& flown, const std::filesystem::path& campaign,
             const std::filesystem::path& trial);

}  // namespace tether::shards
