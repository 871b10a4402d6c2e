#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <stop_token>
#include <string>
#include <vector>

#include <tether/base/warning.h>
#include <tether/campaign/run_campaign.h>
#include <tether/runner/back_end.h>
#include <tether/scenario/campaign.h>

/// The files that the trials of a campaign depend on, and how each trial is run.
namespace tether::runner {

/// Names of the simulators of all conditions in the campaign.
std::set<std::string> simulators(const scenario::Campaign& campaign);

struct CampaignFiles {
  std::vector<std::filesystem::path> files;
  /// What of worlds, UAVs and profiles is not simulated as written; each once.
  std::vector<Warning> warnings;
};
/// All files that the result of a trial depends on. Reads each of them, so that errors in them are
/// found before anything is written.
/// @throws Error(kBadFile) with the file; Error(kUsage) for an unknown simulator; Error(kSetup) if
/// a
///   file of a simulator is missing.
CampaignFiles files_of_trials(const scenario::Campaign& campaign, const FindBackEnd& find_back_end);

/// The arguments of `tether run` for a trial, without --out.
std::vector<std::string> trial_arguments(const campaign::TrialPlan& plan);

/// Runs `tether run` with these arguments, which leaves its result and log in `folder`. None: a
/// stop request ended it. @throws Error(kSetup) if it leaves no result.
std::optional<campaign::TrialResult> run_trial_command(const std::vector<std::string>& of_run,
                                                       const std::filesystem::path& folder,
                                                       const std::stop_token& stop);

/// Runs a trial as a separate `tether run` process, so that a failure cannot affect other trials. A
/// stop request ends it as interrupted. @throws Error(kSetup) if it leaves no result.
campaign::TrialResult run_trial_process(const campaign::TrialPlan& plan,
                                        const std::stop_token& stop);

}  // namespace tether::runner
