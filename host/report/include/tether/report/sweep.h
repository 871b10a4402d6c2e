#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tether/report/plots.h>
#include <tether/report/table.h>

/// Campaigns with a sweep: the same scenario with other values of some keys. Pure functions.
namespace tether::report {

/// The points of one scenario.
struct Sweep {
  std::string scenario;
  std::vector<const campaign::ScenarioResults*> points;  ///< in the order of the campaign file
};
/// One for each scenario that was swept. The results must outlive them.
std::vector<Sweep> sweeps_of(const campaign::CampaignResults& results);

/// A row per point and condition: the values, the share of trials that reach the goal with its
/// exact 95 % interval, and the mean of each metric with its 95 % interval.
Table sweep_table(const Sweep& sweep);

/// Whether the values of the plots' axis differ in how often the goal is reached: a row per pair of
/// values, for each series of the plots, with Fisher's exact test. No rows: there are no pairs.
Table sweep_tests_table(const Sweep& sweep);

/// The share of trials that reach the goal over the key with the most values, with a series
/// per condition and combination of the other values. None if no flight has a result.
std::optional<Plot> sweep_plot(const Sweep& sweep);
/// … or the mean of a metric, with the value of each trial.
std::optional<Plot> sweep_plot(const Sweep& sweep, const std::string& metric);

}  // namespace tether::report
