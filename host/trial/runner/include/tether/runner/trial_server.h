#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include <tether/campaign/run_campaign.h>
#include <tether/runner/trial_request.h>
#include <tether/shards/shard.h>

/// Trials in processes of their own that do not read their world again: a server, which is a
/// process of this program, has it in memory, and each trial is a copy of the server.
namespace tether::runner {

/// As its only argument, makes this program a server of trials.
inline constexpr std::string_view kServeTrials = "--serve-trials";

/// What a server does with a request.
struct TrialService {
  /// Reads what the trial needs into memory. Its failures are left to `run`.
  std::function<void(const TrialRequest& request)> prepare;
  /// Runs the trial, in a copy of the server. @return the exit code.
  std::function<int(const TrialRequest& request)> run;
};
/// Serves the process that started this one until it ends. @pre this process has one thread.
/// @return the exit code.
int serve_trials(const TrialService& service);

/// The result of a trial that a stop request ended.
campaign::TrialResult interrupted(const campaign::TrialPlan& plan);

/// Runs trials, each by a server that does nothing else meanwhile. A failure of a trial cannot
/// affect others. Thread-safe.
class TrialServers {
 public:
  TrialServers();
  ~TrialServers();

  /// Starts so many servers as copies of this process, which have in memory what it has read. A
  /// server that is needed besides is a new process. @pre as for a body of os::ChildCommand.
  void start(int count, const TrialService& service);
  /// Flies the trial, which leaves its result and log in the request's folder. None: a stop request
  /// ended it. @throws Error(kSetup) if it leaves no result.
  std::optional<campaign::TrialResult> run(const TrialRequest& request,
                                           const std::stop_token& stop);
  /// The same for a trial of a campaign. A stop request ends it as interrupted.
  campaign::TrialResult run(const campaign::TrialPlan& plan, const std::stop_token& stop);

 private:
  class Server;
  std::unique_ptr<Server> take();

  std::mutex mutex_;
  std::vector<std::unique_ptr<Server>> idle_;
};

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
