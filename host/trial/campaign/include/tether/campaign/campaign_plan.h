#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <tether/scenario/campaign.h>

/// The trials of a campaign, and the settings on which its results depend.
namespace tether::campaign {

/// One trial to run: a scenario under a condition with a seed.
struct TrialPlan {
  const scenario::Scenario* scenario = nullptr;    ///< of the campaign, which outlives the plan
  const scenario::Condition* condition = nullptr;  ///< of that scenario
  std::uint64_t seed = 0;
  std::filesystem::path folder;  ///< where its record and result go
  bool record_images = false;    ///< in addition to the setting of the scenario
  /// The campaign's own profile, which overrides the scenario's sensors (already part of
  /// `condition`); empty: none.
  std::filesystem::path profile{};
};

/// `<scenario>/<condition's slug>/seed-<seed>`, relative to the campaign's folder.
std::filesystem::path trial_folder(const std::string& scenario, const std::string& condition,
                                   std::uint64_t seed);

/// Every trial of the campaign, for each scenario with the seeds outermost, so that a campaign that
/// is stopped early has about as many trials of each condition. Their folders are below `folder`.
std::vector<TrialPlan> plan_trials(const scenario::Campaign& campaign,
                                   const std::filesystem::path& folder);

/// Whether a trial gives the same result each time, on every machine: under the barrier, with
/// clocks that repeat.
bool repeats(const scenario::Condition& condition);

/// Trials that may run in parallel, up to `jobs` at a time.
struct Batch {
  int jobs = 1;
  std::vector<const TrialPlan*> plans;
};

/// How many trials like `plan` may run in parallel on `jobs` cores. Under the barrier with a clock
/// that other load does not affect: as many as there are cores. In free running, where the wall
/// clock advances the simulation: in the embedded simulator as many as leave half of the cores
/// idle, where each UAV has a SUT and a camera (ADR 0015); in any other simulator one, since its
/// load is unknown. With a wall clock, on a target with a limited number of cores, or on one core:
/// one.
/// @pre jobs ≥ 1; the scenario has a UAV.
int parallel_trials(const TrialPlan& plan, int jobs);

/// The conditions of each seed in an order of its own, drawn by key: what alternates from flight to
/// flight must not look like a condition.
std::vector<const TrialPlan*> in_order_of_flight(std::vector<const TrialPlan*> plans);

/// The plans in the order of running: those under the barrier, then the free-running ones. Batches
/// run one after the other.
std::vector<Batch> make_batches(const std::vector<const TrialPlan*>& plans, int jobs);

/// @throws Error(kUsage) about "--jobs" if `jobs` is less than 1, or more than 1 although a
/// condition
///   measures its SUT by the wall clock or uses an external simulator that is given by its address.
void require_jobs_allowed(const scenario::Campaign& campaign, int jobs);

/// What must be equal for results to be comparable: name → value, for instance "tether" → "0.1.0",
/// "file scenarios/face_anchor.toml" → digest of its content.
using Settings = std::map<std::string, std::string>;
/// Begins the name of a setting that is a file's digest. The rest is the file.
inline constexpr std::string_view kFileSetting = "file ";

/// Every file that the campaign's scenarios name, and each existing regular file among the fixed
/// arguments of a SUT's command (as `sut.py` in ["python3", "sut.py"]). Without the campaign file
/// itself, so that trials can be added to a folder.
std::vector<std::filesystem::path> files_of(const scenario::Campaign& campaign);

/// The digests of `files` (those of files_of() and any others that the caller adds), the campaign's
/// own profile of each scenario, and `versions` (program, simulator, machine, SUT, …).
/// @throws Error(kBadFile) if a file cannot be read.
Settings campaign_settings(const scenario::Campaign& campaign, const Settings& versions,
                           const std::vector<std::filesystem::path>& files);

/// Checks that the files are unchanged since `settings` = campaign_settings(campaign, …, files).
/// Thread-safe.
/// @throws Error(kBadFile) about the first file that is not.
void require_unchanged(const scenario::Campaign& campaign, const Settings& settings,
                       const std::vector<std::filesystem::path>& files);

}  // namespace tether::campaign
