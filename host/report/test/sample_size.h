#pragma once

#include <string>

#include <tether/report/size_report.h>

namespace tether::report {

/// Ten flights of "turn" under "target": those up to 3 × slower reach the goal, with a time that is
/// 20 % of its limit for each time slower.
inline SizeReport sample_size() {
  SizeReport report;
  report.scenario = "turn";
  report.most_flights = 300;
  report.question = {.least = 1.0, .most = 10.0};
  report.synchronised.condition = "target";
  sizing::Answer& answer = report.synchronised.answer;
  answer.threshold = {3.1, 2.7, 3.6};
  answer.is_narrow = true;
  for (int i = 0; i < 10; ++i) {
    campaign::TrialResult trial;
    trial.seed = static_cast<std::uint64_t>(i + 1);
    const double slowdown = 1.0 + 0.5 * i;
    trial.outcome =
        slowdown <= 3.0 ? campaign::Outcome::kGoalReached : campaign::Outcome::kGoalMissed;
    campaign::MetricValue metric{
        "time_required", "time_required", "Time required", "s", {}, "", {}};
    metric.value = 2.0 * slowdown;
    metric.max = 6.5;
    trial.metrics = {metric};
    report.synchronised.flights.push_back(flight_of(trial, slowdown));
    report.synchronised.trials.push_back(trial);
    report.synchronised.curve.push_back(
        {slowdown, {0.9 - 0.08 * i, 0.8 - 0.08 * i, 1.0 - 0.08 * i}});
  }
  report.boards = {{"pi.toml", 1.9, 1.7, 2.1}};
  report.settings = {{"tether", "0.1.0"}, {"file <x>", "abc"}};
  return report;
}

}  // namespace tether::report
