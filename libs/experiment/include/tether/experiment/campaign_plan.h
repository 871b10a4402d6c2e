#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <tether/scenario/campaign.h>

/// What a campaign will run, and what its results rest on.
namespace tether::experiment {

/// One trial to run: a scenario under a condition with a seed.
struct TrialPlan {
  const scenario::Scenario* scenario = nullptr;    ///< of the campaign, which outlives the plan
  const scenario::Condition* condition = nullptr;  ///< of that scenario
  std::uint64_t seed = 0;
  std::filesystem::path folder;  ///< where its record and result go
};

/// `<scenario>/<condition's slug>/seed-<seed>`, relative to the campaign's folder.
std::filesystem::path trial_folder(const std::string& scenario, const std::string& condition,
                                   std::uint64_t seed);

/// Every trial of the campaign, seeds outermost, so that a campaign that is stopped half-way has
/// about as many trials of each condition. Folders lie below `folder`.
std::vector<TrialPlan> plan_trials(const scenario::Campaign& campaign,
                                   const std::filesystem::path& folder);

/// Whether a trial may run beside others on one machine: its time is CPU time or scripted, and no
/// wall clock moves its simulation.
bool may_run_beside_others(const scenario::Condition& condition);

/// @throws Error(kUsage) with the reason when `jobs` is less than 1, or more than 1 although a
///   condition measures its SUT by the wall clock.
void require_jobs_allowed(const scenario::Campaign& campaign, int jobs);

/// What must be the same for results to be compared: name → value. "tether" → "0.1.0", "file
/// scenarios/face_anchor.toml" → digest of its content.
using Settings = std::map<std::string, std::string>;

/// The digests of every file that the campaign's scenarios name and of `more_files`, and
/// `versions` (program, simulator, machine, SUT, … as the caller knows them). The campaign file
/// itself is left out: more trials of the same may be added to a folder.
/// @throws Error(kBadFile) when a file cannot be read.
Settings campaign_settings(const scenario::Campaign& campaign, const Settings& versions,
                           const std::vector<std::filesystem::path>& more_files = {});

}  // namespace tether::experiment
