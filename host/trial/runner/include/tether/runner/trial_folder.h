#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <tether/campaign/folder_claim.h>
#include <tether/os/file_descriptor.h>

namespace tether::runner {

/// The record in a trial's folder.
inline constexpr const char* kRecordFile = "record.mcap";
inline constexpr const char* kMarginsFile = "margins.mcap";  ///< of the clauses of missions
/// What is not simulated as written; there is none if nothing is.
inline constexpr const char* kWarningsFile = "warnings.txt";
/// Output of the simulator's processes.
inline constexpr const char* kSimulatorLog = "simulator.log";

/// The scenario of a program that was given without one, and how its file begins.
inline constexpr const char* kMadeScenarioFile = "scenario.toml";
inline constexpr std::string_view kMadeScenario = "# Made by `tether run -- PROGRAM`";

/// What happens to an earlier run in a trial's folder.
enum class EarlierRun {
  kRefuse,
  kReplace,  ///< all of its files are removed: those of Tether, and those that its SUTs wrote
};

/// The folder of a trial, created if necessary. While the object exists, no other process of Tether
/// writes to it. It never mixes two runs. Room for the result is reserved, because the record of
/// the trial may fill the disk. Not thread-safe.
class TrialFolder {
 public:
  /// @param kept a file that stays if it is in the folder: the scenario of this run
  /// @throws Error(kUsage), without a change, if another run writes to the folder, it belongs to a
  ///   campaign or is one, or it has an earlier run that must not be replaced or lies beside files
  ///   of others; Error(kSetup) if the file system does not allow it. The subject is the path.
  TrialFolder(const std::filesystem::path& folder, EarlierRun earlier,
              const std::filesystem::path& kept = {});

  /// The files that the SUTs of this run wrote to it so far, relative to it and sorted.
  std::vector<std::string> files_of_suts() const;
  /// Call before the result is written.
  void release_room() { room_ = {}; }

 private:
  std::filesystem::path folder_;
  campaign::FolderClaim claim_;
  os::FileDescriptor room_;                    // of a file without a name
  std::set<std::filesystem::path> of_others_;  // names in it before the run
};

}  // namespace tether::runner
