#pragma once

#include <filesystem>

#include <tether/campaign/folder_claim.h>

namespace tether::runner {

/// The record's file in a trial's folder.
inline constexpr const char* kRecordFile = "record.mcap";
/// What the simulator's own processes print.
inline constexpr const char* kSimulatorLog = "simulator.log";

/// A trial's folder, made if need be, into which only this process writes results while the object
/// lives. Nothing of an earlier trial is left in it that could be taken for this one's.
class TrialFolder {
 public:
  /// @throws Error(kUsage) when another run writes there, or it is a campaign's; Error(kSetup) when
  /// the file system refuses.
  explicit TrialFolder(const std::filesystem::path& folder);

 private:
  campaign::FolderClaim claim_;
};

}  // namespace tether::runner
