#include <algorithm>
#include <charconv>
#include <chrono>
#include <sstream>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <tether/base/error.h>
#include <tether/campaign/campaign_plan.h>
#include <tether/os/captured_run.h>
#include <tether/os/clock.h>
#include <tether/os/interrupt.h>
#include <tether/os/program.h>
#include <tether/os/shell_word.h>
#include <tether/workers/cluster.h>
#include <tether/workers/files_check.h>
#include <tether/workers/shared_folder.h>

namespace tether::workers {
namespace {

namespace fs = std::filesystem;
using campaign::TrialPlan;

/// An array of Slurm has at most so many tasks unless its administrator changed that.
constexpr int kMostTasks = 1000;

Duration now() {
  return os::read_clock(CLOCK_MONOTONIC);
}

std::unique_ptr<Engine> make_engine(const ClusterOptions& options, const fs::path& out,
                                    const RunProgram& run) {
  if (options.slurm) return make_slurm({worker_command(out), options.slurm_options, run});
  return make_unmanaged(now);
}

bool measures_cpu(const TrialPlan* plan) {
  return computer_of(*plan->condition, 0).clock.kind == computer::ClockKind::kCpu;
}

/// Cores of each task; 0: each needs a machine of its own.
int cores_of(std::span<const TrialPlan* const> plans) {
  constexpr int kMostCores = 64;
  int most = 1;
  for (const TrialPlan* plan : plans) {
    int cores = 1;
    // On `cores` cores, another trial beside it would be too many.
    const bool is_free = plan->condition->policy == scenario::Policy::kFreeRunning;
    const auto& target = computer_of(*plan->condition, 0).target;
    if (is_free || (target && target->cores > 0)) {
      while (cores <= kMostCores && campaign::parallel_trials(*plan, 2 * cores) < 2) ++cores;
      if (cores > kMostCores) return 0;
    }
    most = std::max(most, cores);
  }
  return most;
}

// Keys of RoundSettings::command that are not of the campaign.
constexpr const char *kFolder = "folder", *kSlurm = "slurm", *kSlurmOptions = "slurm_options",
                     *kScaleNodes = "scale_nodes", *kJobs = "jobs";

std::map<std::string, std::string> remembered(const Start& start) {
  std::map<std::string, std::string> all = start.command;
  all[kFolder] = start.working_folder.string();
  all[kSlurm] = start.options.slurm ? "yes" : "";
  all[kSlurmOptions] = fmt::format("{}", fmt::join(start.options.slurm_options, "\n"));
  all[kScaleNodes] = start.options.scales_nodes ? "yes" : "";
  all[kJobs] = std::to_string(start.jobs);
  return all;
}

Round round_in(const SharedFolder& folder) {
  if (auto round = newest_round(folder)) return *std::move(round);
  const std::string name = folder.root().string();
  throw Error(ErrorCode::kUsage, {name},
              "contains no trials for workers. Start them with tether campaign CAMPAIGN --slurm "
              "--out FOLDER.")
      .about(name);
}

}  // namespace

Answer run_program(const std::vector<std::string>& words) {
  try {
    (void)os::find_program(words.front());
  } catch (const Error&) {
    return {127, "", words.front() + ": not found"};
  }
  const os::Captured captured = os::run_captured(words, "", std::chrono::seconds(30));
  return {captured.timed_out ? 124 : captured.code, captured.out,
          captured.timed_out ? "no answer within 30 s" : captured.err};
}

int jobs_of(const std::optional<int>& given, const ClusterOptions& options, const RunProgram& run) {
  if (given || !options.slurm) return given.value_or(1);
  return static_cast<int>(std::clamp<std::size_t>(slurm_cores(run).value_or(1), 1, kMostTasks));
}

void require_allowed(const scenario::Campaign& campaign, const ClusterOptions& options) {
  const auto refuse = [](const std::string& option) {
    throw Error(ErrorCode::kUsage, option + ": has no effect without --slurm.").about(option);
  };
  if (!options.slurm && !options.slurm_options.empty()) refuse("--slurm-options");
  if (!options.uses_workers()) {
    if (options.scales_nodes) refuse("--scale-nodes");
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

std::string worker_command(const fs::path& out) {
  return fmt::format("{} worker {}", os::shell_word(os::own_file().string()),
                     os::shell_word(fs::absolute(out).string()));
}

Start start_of(const Round& round) {
  std::map<std::string, std::string> all = round.settings().command;
  const auto take = [&](const char* key) {
    const auto node = all.extract(key);
    if (!node.empty()) return node.mapped();
    throw Error(ErrorCode::kBadFile, {round.whole_path("round.json").string()},
                fmt::format("has no \"{}\". Start the trials again in another folder.", key))
        .about(key);
  };
  Start start;
  start.working_folder = take(kFolder);
  start.options.slurm = !take(kSlurm).empty();
  std::istringstream words(take(kSlurmOptions));
  for (std::string word; std::getline(words, word);) start.options.slurm_options.push_back(word);
  start.options.scales_nodes = !take(kScaleNodes).empty();
  const std::string jobs = take(kJobs);
  std::from_chars(jobs.data(), jobs.data() + jobs.size(), start.jobs);
  start.command = std::move(all);
  return start;
}

Start last_start(const fs::path& out) {
  return start_of(round_in(SharedFolder(fs::absolute(out))));
}

Start cancel_jobs(const fs::path& out, const RunProgram& run) {
  const SharedFolder folder(fs::absolute(out));
  const Round round = round_in(folder);
  Start start = start_of(round);
  // The options of sbatch are of no use here.
  const ClusterOptions options{.slurm = start.options.slurm};
  cancel(round, *make_engine(options, out, run));
  return start;
}

Cluster::Cluster(Start start, fs::path out, Request request, const RunProgram& run)
    : start_(std::move(start)),
      out_(std::move(out)),
      request_(std::move(request)),
      engine_(make_engine(start_.options, out_, run)) {
  start_.jobs = std::max(1, start_.jobs);
  if (start_.jobs > kMostTasks)
    throw Error(ErrorCode::kUsage, fmt::format("--jobs {}: a job array has at most {} tasks.",
                                               start_.jobs, kMostTasks))
        .about("--jobs");
}

Collected Cluster::fly(std::span<const TrialPlan* const> plans, const std::vector<fs::path>& files,
                       std::size_t done_before, const std::stop_token& stop,
                       const std::function<void(const std::string&)>& tell,
                       const campaign::ProgressCallback& progress) {
  if (plans.empty()) return {};
  const SharedFolder folder(fs::absolute(out_));
  const CollectSetup setup{
      .settings = {.beats = !start_.options.slurm,
                   .measures_nodes = std::ranges::any_of(plans, measures_cpu),
                   .scales_nodes = start_.options.scales_nodes,
                   .files = digests_of(files),
                   .command = remembered(start_)},
      .order = {.tasks = static_cast<std::size_t>(start_.jobs), .cores = cores_of(plans)},
      .request = request_,
      .done_before = done_before,
      .stop = stop,
      .detaches = start_.options.detach,
      .now = now,
      .sleep = [&](Duration pause) { os::sleep_unless_stopped(pause, stop); },
      .tell = tell,
      .progress = progress};
  std::vector<TrialPlan> absolute;
  std::vector<const TrialPlan*> wanted;
  absolute.reserve(plans.size());
  for (const TrialPlan* plan : plans) {
    absolute.push_back(*plan);
    absolute.back().folder = fs::absolute(plan->folder);
    wanted.push_back(&absolute.back());
  }
  return collect(folder, wanted, *engine_, setup);
}

}  // namespace tether::workers
