#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <tether/base/error.h>
#include <tether/os/file_descriptor.h>

namespace tether::campaign {

/// @throws Error(kUsage), about the folder, if it is none and cannot be made, or nothing can be
///   written in it. Makes nothing.
void require_place(const std::filesystem::path& folder);

/// In a campaign's folder: a running campaign locks it and writes its process id into it.
inline constexpr std::string_view kLockFile = ".tether-campaign.lock";

/// The right to write results in a folder, for a run or a campaign. It ends with the object or with
/// the process, however that ends: it consists of advisory locks (flock), which started programs do
/// not inherit. Not thread-safe.
class FolderClaim {
 public:
  enum class By { kRun, kCampaign, kShard };

  /// Makes the folder if it does not exist. Shards of one campaign share its folder with each
  /// other. Waits up to 0.5 s for a process that is being killed.
  /// @throws Error(kUsage), about the folder and without a change, if another run or campaign has
  ///   claimed it, if a campaign that did not start this process runs in a folder above it, if a
  ///   run has claimed a folder below that of this campaign, or if it is the folder of a trial of
  ///   another campaign; Error(kSetup) if the file system refuses.
  FolderClaim(const std::filesystem::path& folder, By by);

 private:
  std::vector<os::FileDescriptor> locks_;
};

/// @throws Error(kUsage) about the folder: results cannot be written there.
[[noreturn]] inline void refuse_folder(const std::filesystem::path& folder,
                                       const std::string& why) {
  throw Error(ErrorCode::kUsage, {folder.string()}, why).about(folder.string());
}

}  // namespace tether::campaign
