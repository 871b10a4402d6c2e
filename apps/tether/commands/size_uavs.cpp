#include "commands/size_axis.h"
#include "options/refuse_option.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <tether/base/text.h>
#include <tether/os/child_process.h>
#include <tether/report/size_report.h>
#include <tether/scenario/shipped_files.h>

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
  require_enough_trials(options, 0.5 * (1.0 - question.confidence));
  return question;
}

/// A campaign that sweeps the number of UAVs.
class UavsAxis final : public SizeAxis {
 public:
  UavsAxis(const SizeOptions& options, const scenario::Scenario& all, report::UavsReport report)
      : SizeAxis(options, all), report_(std::move(report)), search_(report_.question) {
    folder = all.name + "-uavs";
    for (std::size_t uavs = report_.question.least; uavs <= report_.question.most; ++uavs) {
      campaign.scenarios.push_back({.scenario = load(options, uavs),
                                    .conditions = {report_.condition},
                                    .paper_table = "",
                                    .profile = {},
                                    .swept_from = all.name});
      levels.emplace_back(campaign.scenarios.back().scenario.name, report_.condition);
      report_.points.push_back({{uavs}, {}});
    }
    searched = levels.size();
  }

  sizing::Axis& search() override { return search_; }
  std::string name_of(const campaign::TrialPlan& plan) const override {
    return counted(plan.scenario->uavs.size(), "UAV");
  }
  bool add(std::size_t level, const campaign::TrialResult& trial) override {
    const bool is_copy = report::add_flight(report_.points[level], trial);
    if (!is_copy) search_.add(level, trial.outcome == campaign::Outcome::kGoalReached);
    return is_copy;
  }
  report::SizeAnswer answer(const report::SearchOutcome& outcome) override {
    static_cast<report::SearchOutcome&>(report_) = outcome;
    report_.answer = search_.answer();
    report_.pace = report::pace_at_limit(report_);
    return report::size_answer(report_);
  }

 private:
  report::UavsReport report_;
  sizing::UavAxis search_;
};

}  // namespace

std::unique_ptr<SizeAxis> uavs_axis(const SizeOptions& options) {
  require_for_uavs(options);
  const scenario::Scenario all = load(options, std::nullopt);
  const scenario::Condition condition = scenario::pick_condition(all, options.condition);
  require_shared_board(condition, all.name);
  const scenario::Computer& board = condition.computers[condition.seats.front().computer];
  const auto shipped = scenario::ShippedFiles::of_program(os::own_file());
  report::UavsReport report;
  report.scenario = all.name;
  report.most_flights = options.max_trials;
  report.named = shipped.name_of(scenario::ShippedKind::kScenario, all.file);
  report.condition = condition.name;
  report.board = board.name;
  report.cores = board.cores;
  report.question = question_of_uavs(options, all.uavs.size());
  return std::make_unique<UavsAxis>(options, all, std::move(report));
}

}  // namespace tether::app
