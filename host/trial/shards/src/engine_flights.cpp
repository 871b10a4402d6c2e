#include <algorithm>
#include <ctime>
#include <optional>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include <tether/base/error.h>
#include <tether/base/text.h>
#include <tether/campaign/campaign_folder.h>
#include <tether/os/child_process.h>
#include <tether/os/machine.h>
#include <tether/os/text_file.h>
#include <tether/shards/engine_flights.h>

// A call of the engine: lists of the trials that have no result, one for each shard, a script that
// flies one of them, and the engine's command, which ends when all shards have ended. Meanwhile
// results appear in the campaign's folder. Whatever is missing then is for the next call.
namespace tether::shards {
namespace {

namespace fs = std::filesystem;
using campaign::TrialPlan;
using Plans = std::vector<const TrialPlan*>;

constexpr int kMostCalls = 3;
constexpr std::string_view kCallPrefix = "tether-";
constexpr Duration kCancelLimit = std::chrono::seconds(30);
constexpr Duration kMostPause = std::chrono::milliseconds(200);  // before a stop request is seen

Duration now() {
  return os::read_clock(CLOCK_MONOTONIC);
}

/// Cores that a shard needs; 0: its trials need a machine of their own.
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

/// The last words of a shard, else of the engine, which may only have said that it began.
std::string last_words(const fs::path& folder) {
  std::vector<fs::path> logs;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored))
    if (entry.path().extension() == ".log") logs.push_back(entry.path());
  std::ranges::sort(logs);
  std::stable_partition(logs.begin(), logs.end(),
                        [](const fs::path& log) { return log.stem() != "engine"; });
  for (const fs::path& log : logs)
    if (const std::string line = os::last_line(os::read_whole(log)); !line.empty())
      return fmt::format("{}: {}", log.filename().string(), line);
  return "they left no log";
}

class Flights {
 public:
  Flights(const EngineSetup& setup, std::span<const TrialPlan* const> plans,
          std::size_t done_before, const std::stop_token& stop,
          const campaign::ProgressCallback& progress)
      : setup_(setup),
        stop_(stop),
        progress_(progress),
        missing_(plans.begin(), plans.end()),
        done_before_(done_before),
        total_(done_before + plans.size()),
        cores_(cores_of(plans)) {
    require_cores();
  }

  campaign::CampaignOutcome run() {
    for (int call = 1; call <= kMostCalls && !missing_.empty(); ++call) {
      const std::size_t before = missing_.size();
      fly();
      if (outcome_.interrupted) return outcome_;
      if (missing_.size() == before) break;
      if (!missing_.empty() && call < kMostCalls)
        setup_.tell(
            fmt::format("{} without a result: flying again", counted(missing_.size(), "trial")));
    }
    for (const TrialPlan* plan : missing_)
      if (exists(*plan)) ++outcome_.failed;
    require_some();
    if (missing_.empty()) remove_calls();
    return outcome_;
  }

 private:
  static bool exists(const TrialPlan& plan) {
    std::error_code ignored;
    return fs::exists(plan.folder / campaign::kResultFile, ignored);
  }

  void require_cores() const {
    if (cores_ == 1 || (cores_ > 1 && setup_.engine.gives_cores())) return;
    throw Error(
        ErrorCode::kUsage,
        fmt::format("--engine: a trial of this campaign needs {}, which {} cannot give it. Fly it "
                    "without --engine, or use {{cores}} in the engine's command.",
                    cores_ == 0 ? "a machine of its own" : fmt::format("{} cores", cores_),
                    setup_.engine.file.string()))
        .about("--engine");
  }

  /// Trials are without a result, not even one of a failed set-up.
  void require_some() const {
    const auto lost =
        std::ranges::count_if(missing_, [](const auto* one) { return !exists(*one); });
    if (lost == 0) return;
    throw Error(ErrorCode::kSetup, {setup_.campaign.string()},
                fmt::format("{} of {} have no result, because their shards ended ({}). Correct "
                            "that, and continue with --resume.",
                            lost, counted(total_, "trial"), last_words(folder_)))
        .about("--engine");
  }

  /// Their lists and logs are of no use any more, nor are those of calls that were interrupted.
  void remove_calls() const {
    const fs::path shards = setup_.campaign / campaign::kShardsFolder;
    std::error_code ignored;
    std::vector<fs::path> calls;
    for (const auto& entry : fs::directory_iterator(shards, ignored))
      if (entry.path().filename().string().starts_with(kCallPrefix)) calls.push_back(entry.path());
    for (const fs::path& call : calls) fs::remove_all(call, ignored);
    fs::remove(shards, ignored);  // unless it has something else
  }

  void fly() {
    const std::string name = std::string(kCallPrefix) +
                             os::digest_of(fmt::format("{} {} {} {}", setup_.campaign.string(),
                                                       os::utc_now(), ::getpid(), missing_.size()));
    folder_ = fs::absolute(setup_.campaign) / campaign::kShardsFolder / name;
    const std::vector<TrialList::Trial> trials = trials_of(missing_);
    const std::vector<std::size_t> seeds = seed_numbers(trials);
    const EngineCall call{.name = name,
                          .folder = folder_,
                          .script = folder_ / "shard.sh",
                          .shards = std::min(setup_.shards, 1 + *std::ranges::max_element(seeds)),
                          .cores = cores_};
    write_parts(call, trials, seeds);
    os::write_file_atomically(folder_ / "input", filled(setup_.engine.input, setup_.engine, call));
    os::ChildProcess engine({.arguments = filled(setup_.engine.command, setup_.engine, call),
                             .environment = {},
                             .log = folder_ / "engine.log",
                             .input = folder_ / "input"});
    Duration next_look = now() + setup_.look_period;
    while (!engine.wait(std::min(setup_.look_period, kMostPause))) {
      if (stop_.stop_requested()) return cancel(engine, call);
      const Duration began = now();
      if (began < next_look) continue;
      look();
      // Looking must not load the server of a shared folder.
      next_look = now() + std::max(setup_.look_period, 20 * (now() - began));
    }
    look();
  }

  std::vector<TrialList::Trial> trials_of(const Plans& plans) const {
    std::vector<TrialList::Trial> trials;
    for (const TrialPlan* plan : plans)
      trials.push_back({plan->folder.lexically_relative(setup_.campaign), setup_.request(*plan)});
    return trials;
  }

  void write_parts(const EngineCall& call, const std::vector<TrialList::Trial>& trials,
                   const std::vector<std::size_t>& seeds) {
    std::error_code failed;
    fs::create_directories(call.folder, failed);
    if (failed)
      throw Error(ErrorCode::kSetup, {call.folder.string()},
                  "cannot be made: " + failed.message() + ".")
          .about(setup_.campaign.string());
    std::vector<TrialList> parts(call.shards, {.files = digests_of(setup_.files)});
    for (std::size_t i = 0; i < missing_.size(); ++i) {
      TrialList& part = parts[seeds[i] % call.shards];
      part.measures = part.measures || !campaign::repeats(*missing_[i]->condition);
      part.trials.push_back(trials[i]);
    }
    for (std::size_t i = 0; i < parts.size(); ++i)
      os::write_file_atomically(call.folder / fmt::format("part-{}.json", i + 1),
                                to_json(parts[i]));
    os::write_file_atomically(
        call.script,
        fmt::format("#!/bin/sh\n# Flies part $1 of {}.\ncd {} || exit 3\nfolder={}\n"
                    "exec {} \"$folder/part-$1.json\" > \"$folder/shard-$1.log\" 2>&1\n",
                    call.shards, os::shell_word(fs::current_path().string()),
                    os::shell_word(call.folder.string()), setup_.shard_command));
    fs::permissions(call.script, fs::perms(0755));
  }

  /// Results that have appeared.
  void look() {
    Plans still;
    for (const TrialPlan* plan : missing_) {
      const auto result = stop_.stop_requested() ? std::nullopt : campaign::result_in(plan->folder);
      if (!result) {
        still.push_back(plan);
        continue;
      }
      ++outcome_.ran;
      if (result->outcome == campaign::Outcome::kFailed) ++outcome_.failed;
      report(plan, &*result);
    }
    missing_ = std::move(still);
  }

  void report(const TrialPlan* plan, const campaign::TrialResult* result) const {
    if (progress_)
      progress_({.done = done_before_ + outcome_.ran,
                 .total = total_,
                 .failed = outcome_.failed,
                 .time_left = {},
                 .latest = plan,
                 .result = result});
  }

  void cancel(os::ChildProcess& engine, const EngineCall& call) {
    engine.terminate();
    (void)engine.wait(kCancelLimit);
    if (!setup_.engine.cancel.empty()) {
      os::ChildProcess ending({.arguments = filled(setup_.engine.cancel, setup_.engine, call),
                               .environment = {},
                               .log = call.folder / "engine.log",
                               .appends = true});
      (void)ending.wait(kCancelLimit);
    }
    look();
    outcome_.interrupted = true;
  }

  const EngineSetup& setup_;
  const std::stop_token& stop_;
  const campaign::ProgressCallback& progress_;
  Plans missing_;
  std::size_t done_before_, total_;
  int cores_;
  fs::path folder_;  ///< of the newest call
  campaign::CampaignOutcome outcome_;
};

}  // namespace

campaign::CampaignOutcome fly_by_engine(const EngineSetup& setup,
                                        std::span<const TrialPlan* const> plans,
                                        std::size_t done_before, const std::stop_token& stop,
                                        const campaign::ProgressCallback& progress) {
  if (plans.empty()) return {};
  return Flights(setup, plans, done_before, stop, progress).run();
}

}  // namespace tether::shards
