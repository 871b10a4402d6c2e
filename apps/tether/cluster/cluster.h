#pragma once

#include "commands/commands.h"

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include <tether/campaign/run_campaign.h>
#include <tether/workers/collect.h>
#include <tether/workers/engine.h>

/// Trials that are flown by `tether worker` on other machines, for `tether campaign` and `size`.
namespace tether::app {

/// True if the trials are not flown by this process.
bool uses_workers(const ClusterOptions& options);

/// Of --jobs: what was given, or one for each core of the cluster, or 1.
int jobs_of(const std::optional<int>& given, const ClusterOptions& options);

/// @throws Error(kUsage) about --slurm if a condition must not be flown in parallel, or about an
///   option that has no effect.
void require_workers_allowed(const scenario::Campaign& campaign, const ClusterOptions& options);

/// The setting "machine" of results that are of several.
inline constexpr const char* kManyMachines = "those of workers";

class Cluster {
 public:
  /// @param command what --collect needs to go on; empty: of tether size, which has no --collect.
  /// @throws Error(kUsage) and Error(kSetup) if there is no such engine, before anything is
  /// written.
  Cluster(const ClusterOptions& options, int jobs, std::filesystem::path out,
          std::map<std::string, std::string> command);

  /// @param files on which results depend.
  workers::Collected fly(std::span<const campaign::TrialPlan* const> plans,
                         const std::vector<std::filesystem::path>& files, std::size_t done_before,
                         const std::stop_token& stop, const campaign::ProgressCallback& progress);

 private:
  void end_or_leave(const workers::Collected& collected, const std::stop_token& stop);

  ClusterOptions options_;
  std::size_t tasks_;
  std::filesystem::path out_;
  std::map<std::string, std::string> command_;
  std::unique_ptr<workers::Engine> engine_;
};

/// The command that was recorded in the campaign's folder by the collector that started workers.
/// @throws Error(kUsage) about the folder if there is none.
std::map<std::string, std::string> recorded_command(const std::filesystem::path& out);

/// Cancels the jobs of the folder. @throws Error(kUsage) about the folder if it has none.
int cancel_jobs(const std::filesystem::path& out);

}  // namespace tether::app
