#include "commands/size_uavs.h"

#include "back_ends.h"
#include "cluster/cluster.h"
#include "commands/size_flights.h"
#include "options/junit_option.h"
#include "options/refuse_option.h"
#include "options/trial_options.h"
#include "reading/world_options.h"
#include "terminal/say.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/campaign/campaign_folder.h>
#include <tether/campaign/run_campaign.h>
#include <tether/os/text_file.h>
#include <tether/report/gnuplot.h>
#include <tether/report/uavs_report.h>
#include <tether/runner/campaign_trials.h>
#include <tether/runner/trial_folder.h>
#include <tether/runner/trial_server.h>
#include <tether/scenario/campaign.h>

namespace tether::app {

namespace {

/// The scenario with its first so many UAVs; all of them without a number.
scenario::Scenario load(const SizeOptions& options, std::optional<std::size_t> uavs) {
  std::vector<scenario::Setting> settings;
  if (uavs) settings = {{std::string(scenario::kUavCount), std::to_string(*uavs)}};
  return load_sized_scenario(options, settings);
}

void require_for_uavs(const SizeOptions& options) {
  const auto refuse = [](const char* option, bool is_given, const char* what) {
    if (is_given) refuse_option(option, fmt::format("does not apply to --axis uavs. {}", what));
  };
  refuse("--target", !options.targets.empty(),
         "Name the board in the scenario's [[target]], which the UAVs share.");
  refuse("--interval", options.interval.has_value(), "The answer is a whole number of UAVs.");
  refuse("--unsynchronised", !options.unsynchronised.empty(),
         "Without synchronisation, nothing is shared: fly that condition with tether campaign.");
}

void require_shared_board(const scenario::Condition& condition, const std::string& scenario) {
  const auto is_of_first = [&](const scenario::Seat& seat) {
    return seat.computer == condition.seats.front().computer;
  };
  const bool is_shared = condition.seats.size() > 1 &&
                         std::ranges::all_of(condition.seats, is_of_first) &&
                         condition.policy == scenario::Policy::kConservativeBarrier;
  if (!is_shared)
    refuse_option("--axis",
                  fmt::format("uavs needs a synchronised condition in which all UAVs, at least "
                              "two, share one [[target]] (found: \"{}\" of {}).",
                              condition.name, scenario));
}

sizing::UavQuestion question_of_uavs(const SizeOptions& options, std::size_t uavs) {
  const std::vector<double> between =
      options.between.value_or(std::vector<double>{1.0, static_cast<double>(uavs)});
  for (const double bound : between)
    if (bound != std::floor(bound) || bound < 1.0 || bound > static_cast<double>(uavs))
      refuse_option("--between", fmt::format("{} is not a number of UAVs. The scenario has {}: use "
                                             "whole numbers from 1 to {}.",
                                             bound, uavs, uavs));
  if (between.at(0) > between.at(1))
    refuse_option("--between", fmt::format("{},{} is not a range. The first must be at most the "
                                           "second.",
                                           between.at(0), between.at(1)));
  const sizing::UavQuestion question{.success = options.success,
                                     .confidence = options.confidence,
                                     .least = static_cast<std::size_t>(between.at(0)),
                                     .most = static_cast<std::size_t>(between.at(1))};
  const auto least_flights = static_cast<std::size_t>(
      std::ceil(std::log(0.5 * (1.0 - question.confidence)) / std::log(question.success)));
  if (options.max_trials < least_flights)
    refuse_option(
        "--max-trials",
        fmt::format("{} flights cannot show a success of {} with a confidence of {}, even "
                    "if all succeed. Use at least {}.",
                    options.max_trials, question.success, question.confidence, least_flights));
  return question;
}

scenario::Campaign campaign_of(const SizeOptions& options, const scenario::Scenario& all,
                               const std::string& condition, const sizing::UavQuestion& question) {
  scenario::Campaign campaign;
  campaign.file = all.file;
  campaign.name = std::string(kSizePrefix) + all.name;
  campaign.description = all.description;
  for (std::uint64_t seed = 1; seed <= options.max_trials; ++seed) campaign.seeds.push_back(seed);
  for (std::size_t uavs = question.least; uavs <= question.most; ++uavs)
    campaign.scenarios.push_back({.scenario = load(options, uavs),
                                  .conditions = {condition},
                                  .paper_table = "",
                                  .profile = {},
                                  .swept_from = all.name});
  return campaign;
}

std::string text_of(const campaign::TrialPlan& plan) {
  const std::size_t uavs = plan.scenario->uavs.size();
  return fmt::format("{} UAV{}, seed {}", uavs, uavs == 1 ? "" : "s", plan.seed);
}

/// The flights: a campaign that sweeps the number of UAVs, of which only those trials are run that
/// the answer needs. Each flight has a seed of its own.
class UavFlights {
 public:
  enum class End { kAnswered, kInterrupted, kFailing };

  UavFlights(const SizeOptions& options, scenario::Campaign campaign,
             const std::filesystem::path& out, std::stop_token stop)
      : campaign_(std::move(campaign)),
        jobs_(jobs_of(options.jobs, options.cluster)),
        stop_(std::move(stop)),
        files_(checked_files(options)),
        settings_([&] {
          campaign::Settings versions = versions_of(campaign_, options.reading);
          if (uses_workers(options.cluster)) versions["machine"] = kManyMachines;
          return campaign::campaign_settings(campaign_, versions, files_);
        }()),
        folder_(out, campaign_, settings_, open_mode(options)) {
    if (uses_workers(options.cluster))
      cluster_.emplace(options.cluster, jobs_, out, std::map<std::string, std::string>{});
    for (const std::string& warning : folder_.warnings()) say("warning: {}\n", warning);
    for (const campaign::TrialPlan& plan : folder_.missing())
      missing_[{plan.scenario->uavs.size(), plan.seed}] = &plan;
  }

  End fly(report::UavsReport& report) {
    report_ = &report;
    report.settings = settings_;
    for (const scenario::CampaignScenario& entry : campaign_.scenarios)
      report.points.push_back({entry.scenario.uavs.size(), {}});
    take_earlier();
    const campaign::TrialPlan any{
        &campaign_.scenarios.back().scenario,
        campaign_.scenarios.back().scenario.find_condition(report.condition),
        0,
        {}};
    const auto at_once = static_cast<std::size_t>(campaign::parallel_trials(any, jobs_));
    for (std::size_t failures = 0;;) {
      report.answer = sizing::answer_by_uavs(report.question, report::uav_levels(report.points));
      const std::size_t left = report.most_flights - (next_seed_ - 1);
      if (report.answer.is_decided() || left == 0) return End::kAnswered;
      std::vector<const campaign::TrialPlan*> plans;
      for (std::size_t i = 0; i < std::min(at_once, left); ++i)
        plans.push_back(
            missing_.at({report.answer.next[i % report.answer.next.size()], next_seed_++}));
      if (!run(plans)) return End::kInterrupted;
      const std::size_t before = report.not_flown.size();
      for (const campaign::TrialPlan* plan : plans) take(*plan);
      failures += report.not_flown.size() - before;
      if (failures >= kMostFailedFlights) return End::kFailing;
    }
  }

 private:
  using Key = std::pair<std::size_t, std::uint64_t>;  // UAVs and seed

  std::vector<std::filesystem::path> checked_files(const SizeOptions& options) const {
    require_workers_allowed(campaign_, options.cluster);
    campaign::require_jobs_allowed(campaign_, jobs_);
    require_ports(campaign_, jobs_);
    const auto [files, warnings] = runner::files_of_trials(campaign_, find_back_end);
    if (!warnings.empty())
      say("{}\n", summary_of(warnings, std::string(runner::kWarningsFile) + " of each flight"));
    return files;
  }

  /// False: interrupted.
  bool run(const std::vector<const campaign::TrialPlan*>& plans) {
    const auto show = [&](const campaign::CampaignProgress& progress) {
      if (progress.result != nullptr)
        say("{}  {}: {}\n", report::flights_of(*report_) + progress.done, text_of(*progress.latest),
            campaign::name(progress.result->outcome));
    };
    if (cluster_)
      return cluster_->fly(plans, files_, 0, stop_, show).end == workers::CollectEnd::kComplete;
    const auto fly_one = [&](const campaign::TrialPlan& plan) { return servers_.run(plan, stop_); };
    const auto check = [&] { campaign::require_unchanged(campaign_, settings_, files_); };
    return !campaign::run_trials(plans, fly_one,
                                 {.jobs = jobs_, .stop = stop_, .wall = {}, .check = check}, show)
                .interrupted;
  }

  void take(const campaign::TrialPlan& plan) {
    const campaign::TrialResult trial = campaign::read_result(plan.folder);
    if (trial.outcome == campaign::Outcome::kFailed) {
      report_->not_flown.push_back(fmt::format("{}: {}", text_of(plan), trial.reason));
      return;
    }
    report_->points[plan.scenario->uavs.size() - report_->question.least].trials.push_back(trial);
  }

  void take_earlier() {
    for (const campaign::TrialPlan& plan : campaign::plan_trials(campaign_, folder_.path())) {
      if (missing_.contains({plan.scenario->uavs.size(), plan.seed})) continue;
      take(plan);
      next_seed_ = std::max(next_seed_, plan.seed + 1);
    }
  }

  scenario::Campaign campaign_;
  int jobs_;
  std::stop_token stop_;
  std::vector<std::filesystem::path> files_;
  campaign::Settings settings_;
  campaign::CampaignFolder folder_;
  std::map<Key, const campaign::TrialPlan*> missing_;
  runner::TrialServers servers_;
  std::optional<Cluster> cluster_;
  std::uint64_t next_seed_ = 1;
  report::UavsReport* report_ = nullptr;
};

/// Of a flight with too many UAVs or, without one, with the most.
std::optional<report::Pace> pace_of_limit(const report::UavsReport& report,
                                          const std::filesystem::path& out) try {
  const campaign::TrialResult* trial = nullptr;
  for (const report::UavsPoint& point : report.points) {
    if (point.trials.empty()) continue;
    trial = &point.trials.front();
    if (point.uavs >= report.answer.too_many) break;
  }
  if (trial == nullptr) return std::nullopt;
  return report::read_pace(
      out / campaign::trial_folder(trial->scenario, trial->condition, trial->seed) / "record.mcap");
} catch (const Error&) {
  return std::nullopt;
}

void write_uavs(report::UavsReport& report, const std::filesystem::path& out) {
  report.pace = pace_of_limit(report, out);
  os::write_file_atomically(out / kSizeFile, report::uavs_json(report));
  fmt::print("{}", report::answer_text(report::uavs_answers(report), report::uavs_advice(report),
                                       report::Markup::kPlain));
  os::write_file_atomically(out / kSizeDrawing, report::draw_svg(report::uavs_plot(report)));
  os::write_file_atomically(out / campaign::kReportFile, report::uavs_page(report));
  fmt::print("Page: {}\nDrawing: {}\nNumbers: {}\n", (out / campaign::kReportFile).string(),
             (out / kSizeDrawing).string(), (out / kSizeFile).string());
}

}  // namespace

int find_uavs(const SizeOptions& options, const std::stop_token& stop) {
  require_for_uavs(options);
  const scenario::Scenario all = load(options, std::nullopt);
  const scenario::Condition condition = pick_condition(all, options.condition);
  require_shared_board(condition, all.name);
  const scenario::Computer& board = condition.computers[condition.seats.front().computer];
  report::UavsReport report{.scenario = all.name,
                            .condition = condition.name,
                            .board = board.name,
                            .cores = board.cores,
                            .question = question_of_uavs(options, all.uavs.size()),
                            .most_flights = options.max_trials};
  const std::filesystem::path out =
      options.out.empty() ? std::filesystem::path("out/size") / (all.name + "-uavs") : options.out;
  UavFlights flights(options, campaign_of(options, all, condition.name, report.question), out,
                     stop);
  remove_earlier_answer(out);
  const UavFlights::End end = flights.fly(report);
  if (end != UavFlights::End::kAnswered) {
    for (const std::string& line : report.not_flown) say("tether: {}\n", line);
    say("tether: {} after {} flights; to continue, type: tether size {} --axis uavs --out {} "
        "--resume, with the options of this call\n",
        end == UavFlights::End::kInterrupted ? "interrupted" : "stopped, because flights fail,",
        report::flights_of(report), options.scenario.string(), out.string());
    return exit_code(ErrorCode::kSetup);
  }
  write_uavs(report, out);
  if (!options.junit.empty())
    os::write_file_atomically(options.junit, report::to_junit(report, out));
  return report.answer.is_decided() ? 0 : 1;
}

}  // namespace tether::app
