#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include <tether/base/time.h>
#include <tether/campaign/run_campaign.h>
#include <tether/workers/engine.h>
#include <tether/workers/round.h>

/// The other side of workers: plans rounds of trials, waits for results, and plans again what was
/// lost.
namespace tether::workers {

struct CollectSetup {
  RoundSettings settings;  ///< of each round; `job` and `items` are filled in
  Order order;
  std::function<std::string(const campaign::TrialPlan&)> request;  ///< of a plan, as text
  std::size_t done_before = 0;  ///< trials with a result, for the progress
  std::stop_token stop{};
  /// Ends as soon as a round was started.
  bool detaches = false;
  /// Monotonic; for the time left and how often to look.
  std::function<Duration()> now;
  std::function<void(Duration)> sleep;
  std::function<void(const std::string&)> tell = [](const std::string&) {};  ///< one line
  campaign::ProgressCallback progress = [](const campaign::CampaignProgress&) {};
};

enum class CollectEnd {
  kComplete,      ///< each trial has a result, or was lost too often
  kLeft,          ///< stopped or detached; the round is open
  kCancelled,     ///< another process cancelled the jobs
  kNeedsWorkers,  ///< the user has to start workers
};

/// In a round: its jobs were cancelled, and must not be submitted again by who is collecting.
inline constexpr const char* kCancelledFile = "cancelled";
/// Cancels the round's jobs. @throws as Engine::cancel.
void cancel(const Round& round, Engine& engine);

struct Collected {
  CollectEnd end = CollectEnd::kComplete;
  campaign::CampaignOutcome outcome;
  std::vector<std::string> losses{};  ///< of trials: which, where and why; one line each
};

/// Rounds without a single result after which there is no point in another.
inline constexpr std::size_t kMostBarrenRounds = 3;

/// Has the plans flown by workers. Goes on with the round that an earlier call left open. Several
/// callers on any machines may do so at once: each trial gets one result. A trial that was lost
/// kMostLosses times gets a result with the end kEndSetupFailed and the reasons.
/// @pre the folders of the plans are below `folder`; their results are missing.
/// @throws Error(kSetup) if the engine refuses, if its tasks end before they reach the folder, or
/// if
///   kMostBarrenRounds rounds had no result; as SharedFolder.
Collected collect(const SharedFolder& folder, std::span<const campaign::TrialPlan* const> plans,
                  Engine& engine, const CollectSetup& setup);

/// Trials that a worker should claim at once, so that each task has several claims.
std::size_t chunk_for(std::size_t trials, std::size_t tasks);

}  // namespace tether::workers
