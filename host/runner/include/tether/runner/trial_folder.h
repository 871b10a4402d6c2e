#pragma once

#include <filesystem>

#include <tether/campaign/folder_claim.h>
#include <tether/os/file_descriptor.h>

namespace tether::runner {

/// The record in a trial's folder.
inline constexpr const char* kRecordFile = "record.mcap";
/// Output of the simulator's processes.
inline constexpr const char* kSimulatorLog = "simulator.log";

/// The folder of a trial, created if necessary. While the object exists, no other process of Tether
/// writes to it. Results of an earlier trial are removed. Room for the result is reserved, because
/// the record of the trial may fill the disk.
class TrialFolder {
 public:
  /// @throws Error(kUsage) if another run writes to it or it belongs to a campaign; Error(kSetup)
  /// if the file system does not allow it. The subject is the path.
  explicit TrialFolder(const std::filesystem::path& folder);
  /// Call before the result is written.
  void release_room() { room_ = {}; }

 private:
  campaign::FolderClaim claim_;
  os::FileDescriptor room_;  // of a file without a name
};

}  // namespace tether::runner
