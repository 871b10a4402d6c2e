#pragma once

#include "sample_results.h"

#include <vector>

#include <tether/report/verdict.h>

namespace tether::report {

/// `reached` flights on "target" that reach the goal and `missed` that take longer than 5 s.
inline campaign::ScenarioResults flights(std::size_t reached, std::size_t missed) {
  std::vector<double> times_s(reached, 4.0);
  times_s.resize(reached + missed, 6.0);
  campaign::ScenarioResults scenario = sample_results({{"target", times_s}});
  for (campaign::TrialResult& trial : scenario.conditions[0].trials) {
    trial.policy = "conservative_barrier";
    trial.end = campaign::kEndFinished;
    trial.metrics[0].max = 5.0;
    trial.this_run.sizing = {.scenario = "turn", .condition = "target"};
    if (!trial.metrics[0].is_met()) trial.outcome = campaign::Outcome::kGoalMissed;
  }
  return scenario;
}

inline Ruling ruling_of(const campaign::ScenarioResults& scenario) {
  return verdict_of(scenario).conditions[0].ruling;
}

}  // namespace tether::report
