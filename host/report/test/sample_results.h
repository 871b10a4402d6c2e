#pragma once

#include <string>
#include <utility>
#include <vector>

#include <tether/campaign/campaign_results.h>

namespace tether::report {

/// A scenario "turn" with conditions and the "Time required" of their trials, which have the seeds
/// 1, 2, … and reached the goal.
inline campaign::ScenarioResults sample_results(
    const std::vector<std::pair<std::string, std::vector<double>>>& conditions) {
  campaign::ScenarioResults scenario;
  scenario.scenario = "turn";
  scenario.metrics = {"time_required"};
  for (const auto& [name, times_s] : conditions) {
    campaign::ConditionResults& condition = scenario.conditions.emplace_back();
    condition.condition = name;
    condition.planned = times_s.size();
    for (const double time_s : times_s) {
      campaign::TrialResult& trial = condition.trials.emplace_back();
      trial.condition = name;
      trial.seed = condition.trials.size();
      trial.outcome = campaign::Outcome::kGoalReached;
      campaign::MetricValue& metric = trial.metrics.emplace_back();
      metric.name = metric.kind = "time_required";
      metric.label = "Time required";
      metric.unit = "s";
      metric.value = time_s;
    }
  }
  return scenario;
}

}  // namespace tether::report
