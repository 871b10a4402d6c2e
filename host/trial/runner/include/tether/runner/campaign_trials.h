#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include <tether/base/error.h>
#include <tether/runner/trial.h>
#include <tether/scenario/campaign.h>

namespace tether::sim {
class WorldStore;
}

/// The files that the trials of a campaign depend on.
namespace tether::runner {

/// Names of the simulators of all conditions in the campaign.
std::set<std::string> simulators(const scenario::Campaign& campaign);

struct CampaignFiles {
  std::vector<std::filesystem::path> files;
  /// What of worlds, UAVs and profiles is not simulated as written; each once.
  std::vector<Warning> warnings;
};
/// All files that the result of a trial depends on. Reads each of them, so that errors in them are
/// found before anything is written, and keeps the worlds in `worlds`.
/// @throws Error(kBadFile) with the file; Error(kUsage) for an unknown simulator; Error(kSetup) if
///   a file of a simulator is missing, or the simulator cannot hold a world.
CampaignFiles files_of_trials(const scenario::Campaign& campaign, const FindBackEnd& find_back_end,
                              sim::WorldStore& worlds);

}  // namespace tether::runner
