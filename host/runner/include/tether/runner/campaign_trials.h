#pragma once

#include <filesystem>
#include <set>
#include <stop_token>
#include <string>
#include <vector>

#include <tether/campaign/run_campaign.h>
#include <tether/runner/back_end.h>
#include <tether/scenario/campaign.h>

/// What a campaign's trials rest on, and how each is run.
namespace tether::runner {

/// Of the conditions that are flown.
std::set<std::string> simulators(const scenario::Campaign& campaign);

struct CampaignFiles {
  std::vector<std::filesystem::path> files;
  std::set<std::string> warnings;  ///< of profiles that mean nothing to any UAV; each once
};
/// Everything that a trial's result rests on, as far as files go. Each is looked into, so that what
/// is wrong with one shows before anything is written.
/// @throws Error(kBadFile) naming the file; Error(kUsage) for a simulator that there is not;
///   Error(kSetup) when something of a simulator is missing.
CampaignFiles files_of_trials(const scenario::Campaign& campaign, const FindBackEnd& find_back_end);

/// Runs a trial as a `tether run` of its own, so that whatever happens in one leaves the others
/// alone. A stop request ends it as an interrupted one.
/// @throws Error(kSetup) when it leaves no result.
campaign::TrialResult run_trial_process(const campaign::TrialPlan& plan,
                                        const std::stop_token& stop);

}  // namespace tether::runner
