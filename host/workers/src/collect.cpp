#include "lost_trials.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <set>

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/campaign/campaign_folder.h>
#include <tether/campaign/result.h>
#include <tether/os/text_file.h>
#include <tether/workers/collect.h>
#include <tether/workers/worker.h>

// Round after round: plan what has no result, have workers started, look until none is alive, see
// what was lost. That a round is over is known from its tasks, never from a clock of a node.
namespace tether::workers {
namespace {

namespace fs = std::filesystem;
using campaign::TrialPlan;

constexpr Duration kShortestPause = std::chrono::seconds(1),
                   kLongestPause = std::chrono::seconds(15);

std::string name_of(const TrialPlan& plan) {
  return fmt::format("{}, {}, seed {}", plan.scenario->name, plan.condition->name, plan.seed);
}

class Collector {
 public:
  Collector(const SharedFolder& folder, std::span<const TrialPlan* const> plans, Engine& engine,
            const CollectSetup& setup)
      : folder_(folder), engine_(engine), setup_(setup), began_(setup.now()) {
    for (const TrialPlan* plan : plans)
      wanted_[plan->folder.lexically_relative(folder.root()).string()] = plan;
  }

  Collected run() {
    auto round = newest_round(folder_);
    const std::size_t before = round ? round->number() : 0;
    if (round && folder_.read(round->path("closed"))) round.reset();
    for (std::size_t number = before, barren = 0;;) {
      bool is_own = false;
      if (!round) {
        take_or_remove_existing();
        keep_not_flown();
        if (is_complete()) return close(CollectEnd::kComplete);
        if (barren == kMostBarrenRounds) give_up();
        round = create_round(folder_, ++number, settings(), missing_items());
        is_own = round.has_value();
        if (!round) round = newest_round(folder_);  // another collector was faster
        number = round->number();
      }
      const std::size_t flown = results_.size();
      if (const auto end = see_through(*round, is_own)) return close(*end);
      lost_.add_losses_of(*round, results_, last_tasks_, is_cancelled(*round));
      folder_.create(round->path("closed"), "");
      engine_tidy(*round);
      barren = results_.size() > flown ? 0 : barren + 1;
      for (const std::string& line : lost_.take_news()) {
        setup_.tell(line);
        collected_.losses.push_back(line);
      }
      round.reset();
    }
  }

 private:
  bool is_complete() const { return results_.size() == wanted_.size(); }

  Collected close(CollectEnd end) {
    collected_.end = end;
    collected_.outcome.interrupted = end != CollectEnd::kComplete;
    return std::move(collected_);
  }

  [[noreturn]] void give_up() const {
    const auto& losses = collected_.losses;
    throw Error(ErrorCode::kSetup, {folder_.root().string()},
                fmt::format("no trial of the last {} rounds has a result{}. See {}, and continue "
                            "with --resume.",
                            kMostBarrenRounds, losses.empty() ? "" : "; " + losses.back(),
                            (folder_.root() / kWorkersFolder / "rounds").string()))
        .about(folder_.root().string());
  }

  RoundSettings settings() const {
    RoundSettings settings = setup_.settings;
    settings.job = "tether-" + unique_name();
    settings.chunk = chunk_for(wanted_.size() - results_.size(), setup_.order.tasks);
    return settings;
  }

  // In the order of the plans' folders.
  std::vector<Item> missing_items() const {
    std::vector<Item> items;
    for (const auto& [key, plan] : wanted_)
      if (!results_.contains(key)) items.push_back({key, setup_.request(*plan), lost_.losses(key)});
    return items;
  }

  // None: the round is over.
  std::optional<CollectEnd> see_through(const Round& round, bool is_own) {
    const auto known = engine_.tasks(round);
    const bool is_untouched = folder_.list(round.path("workers")).empty();
    if (is_untouched && known && known->empty() && !start(round))
      return setup_.detaches ? CollectEnd::kLeft : CollectEnd::kNeedsWorkers;
    if (setup_.detaches) return CollectEnd::kLeft;
    // The tasks of another collector, or of an earlier call, may not be visible yet.
    const int looks_without_tasks = is_own ? 1 : 3;
    bool has_arrived = !is_untouched;
    const bool was_cancelled =
        is_cancelled(round);  // by an earlier call: what is left is flown now
    for (int idle = 0, strangers = 0; idle < looks_without_tasks;) {
      if (setup_.stop.stop_requested()) return CollectEnd::kLeft;
      const Duration look = setup_.now();
      const auto tasks = engine_.tasks(round);  // before the results: its last may be in by then
      if (tasks) last_tasks_.assign(tasks->begin(), tasks->end());
      find_results();
      if (has_all_of(round)) break;
      const bool is_alive =
          !tasks || std::ranges::any_of(*tasks, [](const Task& task) { return task.is_alive; });
      has_arrived = has_arrived || !folder_.list(round.path("workers")).empty();
      strangers = !has_arrived && !was_cancelled && has_ended_task() ? strangers + 1 : 0;
      if (strangers >= 2) refuse_strangers(round);
      idle = is_alive ? 0 : idle + 1;
      show(nullptr, nullptr);
      if (!is_alive && !was_cancelled && is_cancelled(round)) return CollectEnd::kCancelled;
      if (idle < looks_without_tasks) setup_.sleep(pause(setup_.now() - look));
    }
    return std::nullopt;
  }

  bool is_cancelled(const Round& round) const {
    return folder_.read(round.path(kCancelledFile)).has_value();
  }

  bool start(const Round& round) {
    Order order = setup_.order;
    order.avoid.insert(lost_.nodes().begin(), lost_.nodes().end());
    order.tasks = std::min(order.tasks, (round.settings().items + round.settings().chunk - 1) /
                                            round.settings().chunk);
    return engine_.start(round, order);
  }

  bool has_ended_task() const {
    return std::ranges::any_of(
        last_tasks_, [](const Task& task) { return !task.is_alive && !task.node.empty(); });
  }

  // Twenty times as long as looking took, so that looking costs little, however many trials.
  Duration pause(Duration look) const {
    return std::clamp(std::max(20 * look, (setup_.now() - began_) / 20), kShortestPause,
                      std::max(kLongestPause, 20 * look));
  }

  [[noreturn]] void refuse_strangers(const Round& round) {
    folder_.create(round.path("closed"), "");
    engine_tidy(round);
    const auto ended = std::ranges::find_if(
        last_tasks_, [](const Task& task) { return !task.is_alive && !task.node.empty(); });
    std::string said;
    for (const std::string& log : folder_.list(round.path("logs")))
      if (said.empty()) said = last_line_of(round, log);
    throw Error(ErrorCode::kSetup, {folder_.root().string()},
                fmt::format("task {} ended on {} ({}) and was never seen in this folder{}. Use a "
                            "folder that all nodes share and can write, have tether installed on "
                            "them, and continue with --resume.",
                            ended->name, ended->node, ended->state, said))
        .about(folder_.root().string());
  }

  std::string last_line_of(const Round& round, const std::string& log) const {
    const std::string last = os::last_line(folder_.read(round.path("logs/" + log)).value_or(""));
    return last.empty() ? "" : ": " + last;
  }

  // Tasks that still wait would find nothing to do.
  void engine_tidy(const Round& round) {
    if (std::ranges::none_of(last_tasks_, &Task::is_alive)) return;
    try {
      engine_.cancel(round);
    } catch (const Error&) {
      // Then they start, find nothing, and end.
    }
  }

  bool has_all_of(const Round& round) {
    if (is_complete()) return true;
    if (results_.size() < round.settings().items) return false;
    for (std::size_t shard = 0; shard < round.shards(); ++shard)
      for (const Item& item : round.items(shard))
        if (!results_.contains(item.folder)) return false;
    return true;
  }

  // By listing the folder of each condition that is not complete, not each trial.
  void for_each_new_folder(const std::function<void(const std::string&, const TrialPlan&)>& take) {
    std::map<fs::path, std::size_t> missing;
    for (const auto& [key, plan] : wanted_)
      if (!results_.contains(key)) ++missing[fs::path(key).parent_path()];
    for (const auto& [parent, count] : missing) {
      for (const std::string& name : folder_.list(parent)) {
        const auto wanted = wanted_.find((parent / name).string());
        if (wanted != wanted_.end() && !results_.contains(wanted->first))
          take(wanted->first, *wanted->second);
      }
    }
  }

  void find_results() {
    for_each_new_folder(
        [&](const std::string& key, const TrialPlan& plan) { (void)take(key, plan); });
  }

  // What is left of trials that were not flown by workers, or could not be flown.
  void take_or_remove_existing() {
    for_each_new_folder([&](const std::string& key, const TrialPlan& plan) {
      if (!take(key, plan)) folder_.remove(key);
    });
  }

  bool take(const std::string& key, const TrialPlan& plan) {
    try {
      const campaign::TrialResult result = campaign::read_result(plan.folder);
      const bool is_result =
          result.end != campaign::kEndSetupFailed && result.end != campaign::kEndInterrupted;
      if (is_result) count(key, plan, result);
      return is_result;
    } catch (const Error&) {
      return false;
    }
  }

  void count(const std::string& key, const TrialPlan& plan, const campaign::TrialResult& result) {
    results_.insert(key);
    ++collected_.outcome.ran;
    if (result.outcome == campaign::Outcome::kFailed) ++collected_.outcome.failed;
    show(&plan, &result);
  }

  void keep_not_flown() {
    for (const auto& [key, plan] : wanted_) {
      const std::vector<std::string> losses = lost_.losses(key);
      if (results_.contains(key) || losses.size() < kMostLosses) continue;
      std::string reasons;
      for (const std::string& loss : losses) reasons += (reasons.empty() ? "" : "; ") + loss;
      campaign::TrialResult result = campaign::make_setup_failure(
          *plan->scenario, *plan->condition, plan->seed,
          fmt::format("not flown: lost {} times ({})", losses.size(), reasons));
      result.this_run.attempts = static_cast<int>(losses.size());
      result.this_run.first_failure = losses.front();
      const fs::path staging = fs::path(kWorkersFolder) / "staging" / unique_name();
      folder_.make(staging);
      folder_.make(fs::path(key).parent_path());
      campaign::write_result(folder_.root() / staging, result);
      if (!folder_.rename(staging, key)) folder_.remove(staging);
      count(key, *plan, result);
    }
  }

  void show(const TrialPlan* plan, const campaign::TrialResult* result) const {
    campaign::CampaignProgress now;
    now.done = setup_.done_before + results_.size();
    now.total = setup_.done_before + wanted_.size();
    now.running = static_cast<std::size_t>(std::ranges::count_if(
        last_tasks_, [](const Task& task) { return task.is_alive && !task.is_waiting; }));
    now.failed = collected_.outcome.failed;
    if (!results_.empty())
      now.time_left = (setup_.now() - began_) / static_cast<std::int64_t>(results_.size()) *
                      static_cast<std::int64_t>(wanted_.size() - results_.size());
    now.latest = plan;
    now.result = result;
    setup_.progress(now);
  }

  const SharedFolder& folder_;
  Engine& engine_;
  const CollectSetup& setup_;
  Duration began_;
  std::map<std::string, const TrialPlan*> wanted_;  // by their folder
  std::set<std::string> results_;
  LostTrials lost_{[this](const std::string& key) {
    const auto plan = wanted_.find(key);
    return plan == wanted_.end() ? key : name_of(*plan->second);
  }};
  std::vector<Task> last_tasks_;
  Collected collected_;
};

}  // namespace

std::size_t chunk_for(std::size_t trials, std::size_t tasks) {
  constexpr std::size_t kClaimsPerTask = 8, kMost = 32;
  return std::clamp<std::size_t>(trials / (std::max<std::size_t>(1, tasks) * kClaimsPerTask), 1,
                                 kMost);
}

void cancel(const Round& round, Engine& engine) {
  round.folder().create(round.path(kCancelledFile), "");  // first, so that nobody submits again
  try {
    engine.cancel(round);
  } catch (...) {
    round.folder().remove(round.path(kCancelledFile));
    throw;
  }
}

Collected collect(const SharedFolder& folder, std::span<const TrialPlan* const> plans,
                  Engine& engine, const CollectSetup& setup) {
  return Collector(folder, plans, engine, setup).run();
}

}  // namespace tether::workers
