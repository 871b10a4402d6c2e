#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <tether/scenario/campaign.h>

/// What a campaign will run, and what its results rest on.
namespace tether::campaign {

/// One trial to run: a scenario under a condition with a seed.
struct TrialPlan {
  const scenario::Scenario* scenario = nullptr;    ///< of the campaign, which outlives the plan
  const scenario::Condition* condition = nullptr;  ///< of that scenario
  std::uint64_t seed = 0;
  std::filesystem::path folder;  ///< where its record and result go
  bool record_images = false;    ///< whatever its scenario says
  /// What the campaign lays on top of the scenario's sensors (part of `condition` already); empty:
  /// nothing.
  std::filesystem::path profile{};
};

/// `<scenario>/<condition's slug>/seed-<seed>`, relative to the campaign's folder.
std::filesystem::path trial_folder(const std::string& scenario, const std::string& condition,
                                   std::uint64_t seed);

/// Every trial of the campaign, seeds outermost, so that a campaign that is stopped half-way has
/// about as many trials of each condition. Folders lie below `folder`.
std::vector<TrialPlan> plan_trials(const scenario::Campaign& campaign,
                                   const std::filesystem::path& folder);

/// Trials that may run side by side, so many at a time.
struct Batch {
  int jobs = 1;
  std::vector<const TrialPlan*> plans;
};

/// How many trials like `plan` may run side by side on `jobs` cores. Under the barrier on a clock
/// that other load leaves alone: as many as there are cores. Free running, where the wall clock
/// moves the simulation: as many as leave half of the cores idle, each UAV of the scenario having a
/// SUT and a camera of its own (ADR 0015), in the embedded simulator; in another one, whose load
/// nobody measured, one. On a wall clock, on a target of so many cores, or on one core: one. @pre
/// jobs ≥ 1; the scenario has a UAV.
int trials_side_by_side(const TrialPlan& plan, int jobs);

/// The plans in the order of running: those under the barrier, then those that run free. Nothing
/// runs beside another batch.
std::vector<Batch> make_batches(const std::vector<const TrialPlan*>& plans, int jobs);

/// @throws Error(kUsage) with the reason when `jobs` is less than 1, or more than 1 although a
///   condition measures its SUT by the wall clock, or flies in a simulator that somebody else runs.
void require_jobs_allowed(const scenario::Campaign& campaign, int jobs);

/// What must be the same for results to be compared: name → value. "tether" → "0.1.0", "file
/// scenarios/face_anchor.toml" → digest of its content.
using Settings = std::map<std::string, std::string>;

/// Every file that the campaign's scenarios name, and those regular files that exist and are fixed
/// arguments of a SUT's command (as `sut.py` in ["python3", "sut.py"]). The campaign file itself is
/// left out: more trials of the same may be added to a folder.
std::vector<std::filesystem::path> files_of(const scenario::Campaign& campaign);

/// The digests of `files` (those of files_of(), and what else the caller knows of), the profile
/// that each scenario is given, and `versions` (program, simulator, machine, SUT, … as the caller
/// knows them).
/// @throws Error(kBadFile) when a file cannot be read.
Settings campaign_settings(const scenario::Campaign& campaign, const Settings& versions,
                           const std::vector<std::filesystem::path>& files);

/// Whether the files are still as `settings` = campaign_settings(campaign, …, files) found them.
/// Thread-safe.
/// @throws Error(kBadFile) naming the first file that is not, and what to do.
void require_unchanged(const scenario::Campaign& campaign, const Settings& settings,
                       const std::vector<std::filesystem::path>& files);

}  // namespace tether::campaign
