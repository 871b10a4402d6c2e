#pragma once

#include <filesystem>
#include <stop_token>

#include <tether/campaign/run_campaign.h>
#include <tether/runner/trial_server.h>
#include <tether/shards/shard.h>

namespace tether::runner {

/// Flies those trials of a shard that have no result in the campaign's folder. Each is flown in a
/// folder of this machine, and gets into the campaign's as a whole. Not thread-safe.
/// @param jobs as campaign::CampaignOptions::jobs.
/// @throws Error(kBadFile) about a file or a machine that is not as the list says, before or after
///   a flight, which is then not kept; as campaign::run_trials and shards::hand_in.
campaign::CampaignOutcome fly_shard(const shards::TrialList& list,
                                    const std::filesystem::path& campaign,
                                    const shards::Shard& shard, int jobs, TrialServers& servers,
                                    const std::stop_token& stop,
                                    const campaign::ProgressCallback& progress);

}  // namespace tether::runner
