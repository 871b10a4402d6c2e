#pragma once

#include <filesystem>
#include <optional>

namespace tether::app {

/// What a file or folder is that a user may give to a command.
enum class FileKind {
  kScenario,
  kCampaign,
  kProfile,
  kTarget,
  kWorld,
  kMission,
  kRig,
  kEngine,
  kRecord,
  kRun,             ///< a folder
  kCampaignFolder,  ///< a folder with the trials of a campaign
  kProgram,
};

/// kRun or kCampaignFolder: which results a folder has; none: it has none, or cannot be read.
std::optional<FileKind> results_in(const std::filesystem::path& folder);

/// By its content; none if it is none of them, cannot be read, or could be several.
std::optional<FileKind> kind_of(const std::filesystem::path& path);

/// Checks that a file is not of another kind than the command needs, and that a record exists. A
/// file that is not recognised may be of that kind, and the command says what is wrong with it.
/// @throws Error(kUsage), about the path, that says what it is and which command takes it.
void require_kind(const std::filesystem::path& path, FileKind wanted);

}  // namespace tether::app
