#pragma once

#include <filesystem>
#include <span>
#include <stop_token>
#include <vector>

#include <tether/campaign/run_campaign.h>
#include <tether/workers/cluster.h>

/// What `tether campaign` and `tether size` tell a user whose trials other machines fly.
namespace tether::app {

/// Has workers fly the plans. If they have not flown all, says how to go on.
/// @param files on which results depend.
/// @throws as workers::Cluster::fly.
workers::Collected fly_by_workers(workers::Cluster& cluster,
                                  std::span<const campaign::TrialPlan* const> plans,
                                  const std::vector<std::filesystem::path>& files,
                                  std::size_t done_before, const std::stop_token& stop,
                                  const campaign::ProgressCallback& progress);

/// Cancels the jobs of the folder. @throws Error(kUsage) about the folder if it has none.
int cancel_jobs(const std::filesystem::path& out);

/// How the campaign's workers were started in that folder.
/// @throws Error(kUsage) about the folder if they were not.
workers::Start campaign_in(const std::filesystem::path& out);

}  // namespace tether::app
