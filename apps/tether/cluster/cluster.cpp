// What `tether campaign` and `tether size` do when other machines fly the trials: choose the engine
// that starts workers (Slurm, or the user), refuse what cannot be flown there, collect, and leave
// or cancel what was started. The protocol itself is in host/workers.

#include "cluster/cluster.h"

#include "options/refuse_option.h"
#include "terminal/say.h"

#include <algorithm>
#include <iostream>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <tether/base/error.h>
#include <tether/campaign/campaign_plan.h>
#include <tether/os/captured_run.h>
#include <tether/os/clock.h>
#include <tether/os/interrupt.h>
#include <tether/os/program.h>
#include <tether/os/shell_word.h>
#include <tether/os/terminal.h>
#include <tether/runner/trial_server.h>
#include <tether/workers/files_check.h>
#include <tether/workers/round.h>
#include <tether/workers/shared_folder.h>

namespace tether::app {

namespace {

namespace fs = std::filesystem;

/// An array of Slurm has at most so many tasks unless its administrator changed that.
constexpr std::size_t kMostTasks = 1000;

workers::Answer run_program(const std::vector<std::string>& words) {
  try {
    (void)os::find_program(words.front());
  } catch (const Error&) {
    return {127, "", words.front() + ": not found"};
  }
  const os::Captured captured = os::run_captured(words, "", std::chrono::seconds(30));
  return {captured.timed_out ? 124 : captured.code, captured.out,
          captured.timed_out ? "no answer within 30 s" : captured.err};
}

Duration now() {
  return os::read_clock(CLOCK_MONOTONIC);
}

std::string worker_command(const fs::path& out) {
  return fmt::format("{} worker {}", os::shell_word(os::own_file().string()),
                     os::shell_word(fs::absolute(out).string()));
}

std::unique_ptr<workers::Engine> make_engine(const ClusterOptions& options, const fs::path& out) {
  if (options.slurm)
    return workers::make_slurm({worker_command(out), options.slurm_options, run_program});
  return workers::make_unmanaged(now);
}

bool measures_cpu(const campaign::TrialPlan& plan) {
  return plan.condition->clock == scenario::Clock::kCpu;
}

/// Cores of each task. None: each needs a machine of its own.
std::optional<int> cores_of(std::span<const campaign::TrialPlan* const> plans) {
  constexpr int kMostCores = 64;
  int most = 1;
  for (const campaign::TrialPlan* plan : plans) {
    int cores = 1;
    // On `cores` cores, another trial beside it would be too many.
    const bool is_free = plan->condition->policy == scenario::Policy::kFreeRunning;
    if (is_free || (plan->condition->target && plan->condition->target->cores > 0)) {
      while (cores <= kMostCores && campaign::parallel_trials(*plan, 2 * cores) < 2) ++cores;
      if (cores > kMostCores) return std::nullopt;
    }
    most = std::max(most, cores);
  }
  return most;
}

std::string how_to_continue(const std::string& out, bool is_campaign) {
  return is_campaign ? fmt::format("To continue, type: tether campaign --collect {}", out)
                     : "To continue, repeat tether size with --resume.";
}

bool is_asked_to_cancel() {
  if (::isatty(STDIN_FILENO) == 0 || os::terminal_columns(STDERR_FILENO) == 0) return false;
  say("\nCancel the jobs? Otherwise they go on. [y/N] ");
  std::string answer;
  std::getline(std::cin, answer);
  return answer == "y" || answer == "Y" || answer == "yes";
}

}  // namespace

bool uses_workers(const ClusterOptions& options) {
  return options.slurm || options.detach || options.collects;
}

int jobs_of(const std::optional<int>& given, const ClusterOptions& options) {
  if (given || !options.slurm) return given.value_or(1);
  const auto cores = workers::slurm_cores(run_program);
  return static_cast<int>(std::clamp<std::size_t>(cores.value_or(1), 1, kMostTasks));
}

void require_workers_allowed(const scenario::Campaign& campaign, const ClusterOptions& options) {
  if (!options.slurm && !options.slurm_options.empty())
    refuse_option("--slurm-options", "has no effect without --slurm.");
  if (!uses_workers(options)) {
    if (options.scales_nodes) refuse_option("--scale-nodes", "has no effect without --slurm.");
    return;
  }
  try {
    campaign::require_jobs_allowed(campaign, 2);
  } catch (const Error& error) {
    throw Error(ErrorCode::kUsage, fmt::format("workers fly trials in parallel, which these do not "
                                               "allow: {}",
                                               error.what()))
        .about("--slurm");
  }
}

Cluster::Cluster(const ClusterOptions& options, int jobs, fs::path out,
                 std::map<std::string, std::string> command)
    : options_(options),
      tasks_(static_cast<std::size_t>(std::max(1, jobs))),
      out_(std::move(out)),
      command_(std::move(command)),
      engine_(make_engine(options_, out_)) {
  if (tasks_ > kMostTasks)
    throw Error(ErrorCode::kUsage,
                fmt::format("--jobs {}: a job array has at most {} tasks.", tasks_, kMostTasks))
        .about("--jobs");
  command_["folder"] = fs::current_path().string();
  command_["slurm"] = options_.slurm ? "yes" : "";
  command_["slurm_options"] = fmt::format("{}", fmt::join(options_.slurm_options, "\n"));
  command_["scale_nodes"] = options_.scales_nodes ? "yes" : "";
  command_["jobs"] = std::to_string(tasks_);
}

workers::Collected Cluster::fly(std::span<const campaign::TrialPlan* const> plans,
                                const std::vector<fs::path>& files, std::size_t done_before,
                                const std::stop_token& stop,
                                const campaign::ProgressCallback& progress) {
  if (plans.empty()) return {};
  const workers::SharedFolder folder(fs::absolute(out_));
  const auto cores = cores_of(plans);
  workers::CollectSetup setup{
      .settings = {.beats = !options_.slurm,
                   .measures_nodes = std::ranges::any_of(
                       plans, [](const auto* plan) { return measures_cpu(*plan); }),
                   .scales_nodes = options_.scales_nodes,
                   .files = workers::digests_of(files),
                   .command = command_},
      .order = {.tasks = tasks_, .cores = cores.value_or(0)},
      .arguments = runner::trial_arguments,
      .done_before = done_before,
      .stop = stop,
      .detaches = options_.detach,
      .now = now,
      .sleep = [&](Duration pause) { os::sleep_unless_stopped(pause, stop); },
      .tell = [](const std::string& line) { say("{}\n", line); },
      .progress = progress};
  const std::vector<campaign::TrialPlan> absolute = [&] {
    std::vector<campaign::TrialPlan> all;
    for (const campaign::TrialPlan* plan : plans) {
      all.push_back(*plan);
      all.back().folder = fs::absolute(plan->folder);
    }
    return all;
  }();
  std::vector<const campaign::TrialPlan*> wanted;
  for (const campaign::TrialPlan& plan : absolute) wanted.push_back(&plan);
  workers::Collected collected = workers::collect(folder, wanted, *engine_, setup);
  end_or_leave(collected, stop);
  return collected;
}

void Cluster::end_or_leave(const workers::Collected& collected, const std::stop_token& stop) {
  if (collected.end == workers::CollectEnd::kComplete) return;
  const std::string out = out_.string();
  const bool is_campaign = command_.contains("campaign");
  if (!options_.slurm) {
    say("tether: trials are ready for workers. On machines that share this folder, start: {}\n"
        "Then type: tether campaign --collect {}\n",
        worker_command(out_), out);
  } else if (stop.stop_requested() && is_asked_to_cancel()) {
    cancel_jobs(out_);
  } else if (collected.end == workers::CollectEnd::kCancelled) {
    say("tether: the jobs were cancelled. {}\n", how_to_continue(out, is_campaign));
  } else {
    say("tether: the jobs go on. {}\nTo cancel them: tether campaign --cancel {}\n",
        how_to_continue(out, is_campaign), out);
  }
}

std::map<std::string, std::string> recorded_command(const fs::path& out) {
  const auto round = workers::newest_round(workers::SharedFolder(fs::absolute(out)));
  if (round && round->settings().command.contains("campaign")) return round->settings().command;
  throw Error(ErrorCode::kUsage, {out.string()},
              round ? "contains the flights of tether size. Continue it with tether size --resume."
                    : "contains no trials for workers. Start them with tether campaign CAMPAIGN "
                      "--slurm --out FOLDER.")
      .about(out.string());
}

int cancel_jobs(const fs::path& out) {
  const workers::SharedFolder folder(fs::absolute(out));
  const auto round = workers::newest_round(folder);
  if (!round)
    throw Error(ErrorCode::kUsage, {out.string()}, "contains no trials for workers.")
        .about(out.string());
  ClusterOptions options;
  options.slurm = !round->settings().command.at("slurm").empty();
  workers::cancel(*round, *make_engine(options, out));
  say("tether: the jobs are cancelled; results are kept. {}\n",
      how_to_continue(out.string(), round->settings().command.contains("campaign")));
  return 0;
}

}  // namespace tether::app
