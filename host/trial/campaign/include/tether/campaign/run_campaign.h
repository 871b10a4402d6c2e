#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <stop_token>
#include <string_view>

#include <tether/base/time.h>
#include <tether/campaign/campaign_folder.h>

namespace tether::campaign {

/// The output of a trial's program, in the trial's folder.
inline constexpr std::string_view kTrialLog = "run.log";
/// The same of a second attempt.
inline constexpr std::string_view kSecondTrialLog = "run-2.log";

/// Runs one trial, leaves its record in `plan.folder` (which exists and is empty; at a second
/// attempt it contains the first one's kTrialLog), and returns its result, which run_campaign
/// writes. Called from several threads at once if there are several jobs. A result whose `end` is
/// kEndSetupFailed, or an Error other than kUsage and kBadFile, means that the trial could not be
/// set up; kEndInterrupted, that the user stopped it.
using TrialExecutor = std::function<TrialResult(const TrialPlan& plan)>;

struct CampaignProgress {
  std::size_t done = 0;  ///< trials with a result, those of earlier runs included
  std::size_t total = 0;
  std::size_t running = 0;
  std::size_t failed = 0;               ///< of this run: trials whose outcome is kFailed
  std::optional<Duration> time_left;    ///< wall time, estimated from the trials so far
  const TrialPlan* latest = nullptr;    ///< the trial that started or ended
  const TrialResult* result = nullptr;  ///< its result at its end; valid during the call
};
/// Called at each start and end of a trial, never from two threads at once.
using ProgressCallback = std::function<void(const CampaignProgress&)>;

struct CampaignOptions {
  int jobs = 1;          ///< cores for parallel trials, see parallel_trials()
  std::stop_token stop;  ///< no further trial starts once requested
  /// Monotonic wall time, for the time left only. Default: the machine's.
  std::function<Duration()> wall;
  /// Called after each trial, before its result is kept, from several threads at once if there are
  /// several jobs. An exception ends the run, and that trial counts as not run.
  std::function<void()> check;
};

struct CampaignOutcome {
  std::size_t ran = 0;     ///< trials that now have a result
  std::size_t failed = 0;  ///< of those: outcome kFailed
  bool interrupted = false;
};

/// Runs the missing trials of the folder, batch after batch (see make_batches). Each result is on
/// the disk before the next trial of its thread starts. A trial that could not be set up is tried
/// once more, then kept as a failed one with its reason.
/// @throws Error(kUsage) as `require_jobs_allowed`; after the running trials have ended, also any
///   kUsage or kBadFile of a trial, the exception of `options.check`, or Error(kSetup) if the file
///   system refuses.
CampaignOutcome run_campaign(const CampaignFolder& folder, const scenario::Campaign& campaign,
                             const TrialExecutor& execute, const CampaignOptions& options,
                             const ProgressCallback& progress);

/// The same for some of the missing trials, which are all of its progress.
CampaignOutcome run_trials(std::span<const TrialPlan* const> missing, const TrialExecutor& execute,
                           const CampaignOptions& options, const ProgressCallback& progress);

}  // namespace tether::campaign
