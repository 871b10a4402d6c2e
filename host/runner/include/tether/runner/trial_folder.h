#pragma once

#include <filesystem>

#include <tether/campaign/folder_claim.h>

namespace tether::runner {

/// The record in a trial's folder.
inline constexpr const char* kRecordFile = "record.mcap";
/// What is not simulated as written; there is none if nothing is.
inline constexpr const char* kWarningsFile = "warnings.txt";
/// Output of the simulator's processes.
inline constexpr const char* kSimulatorLog = "simulator.log";

/// The folder of a trial, created if necessary. While the object exists, no other process of Tether
/// writes to it. Results of an earlier trial are removed.
class TrialFolder {
 public:
  /// @throws Error(kUsage) if another run writes to it or it belongs to a campaign; Error(kSetup)
  /// if the file system does not allow it. The subject is the path.
  explicit TrialFolder(const std::filesystem::path& folder);

 private:
  campaign::FolderClaim claim_;
};

}  // namespace tether::runner
