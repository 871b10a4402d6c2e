#include "commands/size_flights.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <tether/scenario/scenario.h>

namespace tether::app {

namespace {

bool has_margins(const scenario::Scenario& scenario) {
  return std::ranges::any_of(scenario.metrics, [](const scenario::Metric& metric) {
    campaign::MetricValue value{metric.name, metric.kind, metric.label, metric.unit, 0.0, "", {}};
    value.max = metric.max;
    value.min = metric.min;
    return report::margin_of(value).has_value();
  });
}

}  // namespace

SizeFlights::SizeFlights(const SizeOptions& options, const Setup& setup,
                         const sizing::CurveGrid& grid, const std::filesystem::path& out,
                         const std::stop_token& stop)
    : setup_(setup),
      grid_(grid),
      trials_(
          options,
          [&] {
            scenario::Campaign campaign = make_campaign(options.max_trials);
            names_ = campaign.scenarios.front().conditions;
            return campaign;
          }(),
          out, stop,
          [](const campaign::TrialPlan& plan) { return "“" + plan.condition->name + "”"; }),
      has_margins_(has_margins(setup.scenario)) {}

scenario::Campaign SizeFlights::make_campaign(std::size_t most) const {
  scenario::Campaign campaign;
  campaign.file = setup_.scenario.file;
  campaign.name = std::string(kSizePrefix) + setup_.scenario.name;
  campaign.description = setup_.scenario.description;
  for (std::uint64_t seed = 1; seed <= most; ++seed) campaign.seeds.push_back(seed);
  scenario::CampaignScenario entry{setup_.scenario, {}, ""};
  entry.scenario.conditions.clear();
  for (const scenario::Condition& condition : setup_.conditions) {
    for (const double slowdown : grid_.slowdowns()) {
      entry.scenario.conditions.push_back(condition);
      scenario::slow_down(entry.scenario.conditions.back(), slowdown);
      entry.conditions.push_back(entry.scenario.conditions.back().name);
    }
  }
  campaign.scenarios.push_back(std::move(entry));
  return campaign;
}

// Bounds from few flights mislead: the final ones can be outside of them.
std::string known_text(const sizing::Threshold& threshold) {
  const bool is_bounded = threshold.low > 0.0 || std::isfinite(threshold.high);
  return threshold.estimate > 0.0 && is_bounded
             ? fmt::format("so far about {:.2g} times slower", threshold.estimate)
             : "no limit is known yet";
}

SizeTrials::Wanted SizeFlights::slowed(std::size_t condition, double slowdown) const {
  const std::vector<double>& all = grid_.slowdowns();
  const auto place = std::ranges::find(all, slowdown) - all.begin();
  return {setup_.scenario.name,
          names_.at(condition * all.size() + static_cast<std::size_t>(place))};
}

SizeTrials::Questions SizeFlights::questions(sizing::Sizing& sizing,
                                             report::SizedCondition& into) const {
  const auto next = [&](std::size_t most) {
    std::vector<SizeTrials::Wanted> wanted;
    into.answer = sizing.answer(most == 0);
    if (into.answer.is_narrow || most == 0) return wanted;
    if (into.copies >= report::kMostCopies) {
      into.answer = sizing.answer(true);
      return wanted;
    }
    for (const double slowdown : sizing.next(most)) wanted.push_back(slowed(0, slowdown));
    return wanted;
  };
  const auto take = [&](const campaign::TrialPlan& plan, const campaign::TrialResult& trial) {
    if (report::add_flight(into, trial, plan.condition->slowdown))
      sizing.skip_copy();
    else
      sizing.add(into.flights.back());
  };
  return {next, take, [&] { return known_text(into.answer.threshold); }};
}

SizeTrials::End SizeFlights::fly(report::SizeReport& report) {
  using End = SizeTrials::End;
  report.settings = trials_.settings();
  report::SizedCondition& own = report.synchronised;
  own.condition = setup_.conditions.front().name;
  sizing::Sizing sizing(grid_, has_margins_);
  End end = trials_.fly(questions(sizing, own), [&](const campaign::TrialPlan& plan) {
    return plan.condition->slowed_from == own.condition;
  });
  own.curve = report::curve_points(sizing.curve(), grid_.question().least, grid_.question().most);
  const bool is_compared = end == End::kAnswered && setup_.conditions.size() > 1;
  if (is_compared && !fly_unsynchronised(report)) end = End::kInterrupted;
  report.not_flown = trials_.not_flown();
  return end;
}

// The same slowdowns and seeds, so that both differ in the synchronisation only.
bool SizeFlights::fly_unsynchronised(report::SizeReport& report) {
  std::vector<std::pair<SizeTrials::Wanted, std::uint64_t>> same;
  const report::SizedCondition& own = report.synchronised;
  for (std::size_t i = 0; i < own.flights.size(); ++i)
    same.emplace_back(slowed(1, own.flights[i].slowdown), own.trials[i].seed);
  sizing::Sizing sizing(grid_, has_margins_);
  report::SizedCondition& other = report.unsynchronised.emplace();
  other.condition = setup_.conditions.back().name;
  if (!trials_.fly_also(same, questions(sizing, other))) return false;
  other.answer = sizing.answer(true);
  other.curve = report::curve_points(sizing.curve(), grid_.question().least, grid_.question().most);
  return true;
}

}  // namespace tether::app
