#include "commands/size_uavs.h"

#include "commands/size_trials.h"
#include "options/junit_option.h"
#include "options/refuse_option.h"
#include "options/trial_options.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include <tether/os/program.h>
#include <tether/report/size_report.h>
#include <tether/report/uavs_report.h>
#include <tether/scenario/campaign.h>
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

/// The flights: a campaign that sweeps the number of UAVs.
SizeTrials::Questions questions(report::UavsReport& report, const scenario::Campaign& campaign) {
  const auto next = [&](std::size_t most) {
    report.answer = sizing::answer_by_uavs(report.question, report::uav_levels(report.points));
    std::vector<SizeTrials::Wanted> wanted;
    if (report.answer.is_decided() || report::copies_in(report) >= report::kMostCopies)
      return wanted;
    for (std::size_t i = 0; i < most; ++i) {
      const std::size_t uavs = report.answer.next[i % report.answer.next.size()];
      const auto& entry = campaign.scenarios[uavs - report.question.least];
      wanted.push_back({entry.scenario.name, entry.conditions.front()});
    }
    return wanted;
  };
  const auto take = [&](const campaign::TrialPlan& plan, const campaign::TrialResult& trial) {
    report.points[plan.scenario->uavs.size() - report.question.least].trials.push_back(trial);
  };
  const auto so_far = [&] {
    const std::size_t carried = report.answer.carried, too_many = report.answer.too_many;
    std::string known =
        carried >= report.question.least ? fmt::format(" at least {}", carried) : "";
    if (too_many <= report.question.most)
      known += fmt::format("{} fewer than {}", known.empty() ? "" : ",", too_many);
    return "UAVs that it carries: " + (known.empty() ? "nothing is known yet" : known.substr(1));
  };
  return {next, take, so_far};
}

std::string name_of(const campaign::TrialPlan& plan) {
  const std::size_t uavs = plan.scenario->uavs.size();
  return fmt::format("{} UAV{}", uavs, uavs == 1 ? "" : "s");
}

}  // namespace

int find_uavs(const SizeOptions& options, const std::stop_token& stop) {
  require_for_uavs(options);
  const scenario::Scenario all = load(options, std::nullopt);
  const scenario::Condition condition = scenario::pick_condition(all, options.condition);
  require_shared_board(condition, all.name);
  const scenario::Computer& board = condition.computers[condition.seats.front().computer];
  const auto shipped = scenario::ShippedFiles::of_program(os::own_file());
  report::UavsReport report{.scenario = all.name,
                            .named = shipped.name_of(scenario::ShippedKind::kScenario, all.file),
                            .condition = condition.name,
                            .board = board.name,
                            .cores = board.cores,
                            .question = question_of_uavs(options, all.uavs.size()),
                            .most_flights = options.max_trials};
  const std::filesystem::path out =
      options.out.empty() ? std::filesystem::path("out/size") / (all.name + "-uavs") : options.out;
  const scenario::Campaign campaign = campaign_of(options, all, condition.name, report.question);
  for (const scenario::CampaignScenario& entry : campaign.scenarios)
    report.points.push_back({entry.scenario.uavs.size(), {}});
  SizeTrials trials(options, campaign, out, stop, name_of);
  report.settings = trials.settings();
  const SizeTrials::End end =
      trials.fly(questions(report, campaign), [](const auto&) { return true; });
  report.not_flown = trials.not_flown();
  if (end != SizeTrials::End::kAnswered) return trials.say_why(end);
  report.pace = report::pace_at_limit(report);
  write_answer(
      {report::uavs_answers(report), report::uavs_advice(report), report::uavs_json(report),
       report::uavs_plot(report), report::uavs_page(report), report::to_junit(report, out)},
      out, options.junit);
  return report::is_answered(report) ? 0 : 1;
}

}  // namespace tether::app
