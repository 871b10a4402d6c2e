#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include <tether/campaign/run_campaign.h>
#include <tether/scenario/campaign.h>
#include <tether/workers/collect.h>
#include <tether/workers/engine.h>

/// The machines that fly a campaign's trials: who starts their workers, what each task needs, and
/// what a later call must know to go on with them.
namespace tether::workers {

struct ClusterOptions {
  bool slurm = false;
  std::vector<std::string> slurm_options{};  ///< of sbatch
  bool detach = false;    ///< start workers, or have the user start them, and end
  bool collects = false;  ///< goes on with the workers of an earlier call
  bool scales_nodes = false;

  /// False if the calling process flies the trials itself.
  bool uses_workers() const { return slurm || detach || collects; }
};

/// Runs a program of this machine for at most 30 s. If there is none of that name: code 127.
Answer run_program(const std::vector<std::string>& words);

/// Of --jobs: what was given, or one for each core of the cluster, or 1.
int jobs_of(const std::optional<int>& given, const ClusterOptions& options,
            const RunProgram& run = run_program);

/// @throws Error(kUsage) about --slurm if a condition must not be flown in parallel, or about an
///   option that has no effect.
void require_allowed(const scenario::Campaign& campaign, const ClusterOptions& options);

/// The shell command of a worker.
std::string worker_command(const std::filesystem::path& out);

/// The setting "machine" of results that are of several.
inline constexpr const char* kManyMachines = "those of workers";

/// What the workers of a folder were started with. Its rounds remember it.
struct Start {
  ClusterOptions options;
  int jobs = 1;
  std::filesystem::path working_folder;  ///< of the call, whose SUTs may name files in it
  /// Of the campaign, as the caller gave them; empty: of tether size, which starts nothing anew.
  std::map<std::string, std::string> command{};
};
/// As the round remembers it. @throws Error(kBadFile) if the round is not of a Cluster.
Start start_of(const Round& round);
/// Of the folder's newest round. @throws Error(kUsage) about the folder if there is none.
Start last_start(const std::filesystem::path& out);

/// Cancels the jobs of the folder's newest round.
/// @returns what they were started with. @throws as last_start; Error(kSetup) as Engine::cancel.
Start cancel_jobs(const std::filesystem::path& out, const RunProgram& run = run_program);

/// Has trials flown below a folder, once or several times.
class Cluster {
 public:
  using Request = std::function<std::string(const campaign::TrialPlan&)>;

  /// @param request of a plan, as text.
  /// @throws Error(kUsage) and Error(kSetup) if there is no such engine, before anything is
  ///   written.
  Cluster(Start start, std::filesystem::path out, Request request,
          const RunProgram& run = run_program);

  const Start& start() const { return start_; }
  const std::filesystem::path& folder() const { return out_; }

  /// @param files on which results depend.
  /// @param done_before trials with a result, for the progress.
  /// @throws as collect.
  Collected fly(std::span<const campaign::TrialPlan* const> plans,
                const std::vector<std::filesystem::path>& files, std::size_t done_before,
                const std::stop_token& stop, const std::function<void(const std::string&)>& tell,
                const campaign::ProgressCallback& progress);

 private:
  Start start_;
  std::filesystem::path out_;
  Request request_;
  std::unique_ptr<Engine> engine_;
};

}  // namespace tether::workers
