#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include <tether/base/time.h>
#include <tether/campaign/run_campaign.h>
#include <tether/shards/engine.h>
#include <tether/shards/shard.h>

namespace tether::shards {

struct EngineSetup {
  Engine engine;
  std::size_t shards = 1;                    ///< at most
  std::filesystem::path campaign;            ///< its folder
  std::vector<std::filesystem::path> files;  ///< on which results depend
  std::string shard_command;  ///< of a shell: flies the list of trials that is its next word
  std::function<std::string(const campaign::TrialPlan&)> request;  ///< of a plan, as text
  std::function<void(const std::string&)> tell;                    ///< one line
  /// How often to look for results.
  Duration look_period = std::chrono::seconds(1);
};

/// Has trials flown by the shards of an engine, which share the campaign's folder. What a killed
/// shard or a lost machine leaves is flown again, in up to three calls of the engine. Not
/// thread-safe.
/// @param plans with folders below the campaign's; their results are missing.
/// @param done_before trials with a result, for the progress.
/// @returns `interrupted` after a stop request: the shards are cancelled, and results are kept.
/// @throws Error(kUsage) about --engine if the trials must not run beside others, or need cores
///   that the engine cannot give; Error(kSetup) if it cannot be started, or if a call brings no
///   result, with the last words of the engine or of a shard.
campaign::CampaignOutcome fly_by_engine(const EngineSetup& setup,
                                        std::span<const campaign::TrialPlan* const> plans,
                                        std::size_t done_before, const std::stop_token& stop,
                                        const campaign::ProgressCallback& progress);

}  // namespace tether::shards
