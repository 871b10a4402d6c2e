#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include <tether/campaign/campaign_results.h>
#include <tether/record/reader.h>

/// Plots of runs and campaigns as gnuplot scripts with their data inline. Pure functions: equal
/// arguments give equal scripts. Long records are thinned, so that each drawing stays below 300 kB.
namespace tether::report {

/// What gnuplot is to draw.
struct Plot {
  std::string script;
  std::string title;  ///< one line; what a screen reader says
};

/// One run among those of a plot.
struct PlottedRun {
  const record::Record* record = nullptr;
  std::string uav;
  std::string label;       ///< in the legend: the condition
  std::size_t series = 0;  ///< chooses the colour: the condition's place in its scenario
};

enum class Extent {
  kWhole,
  kFirstInteractions,  ///< the first 20: a whole run is a straight line at a distance
};

/// Simulated and execution time against wall time, interactions marked (paper, Fig. 4). Without the
/// barrier ET is not tied to ST, and ST stands alone. None: fewer than two interactions of that UAV
/// have wall times.
std::optional<Plot> timeline_plot(const PlottedRun& run, Extent extent);

/// The lag ε = ET − ST of each request when it arrived, against ST. None: without the barrier
/// nothing lags, or fewer than two interactions.
std::optional<Plot> lag_plot(const PlottedRun& run);

/// Paths from above with ticks in the direction of the nose, start and end, and the first run's
/// anchors to scale (paper, Figs. 6, 7); dashed, where a SUT wrote it down, its own dead reckoning
/// from the true start. Both axes have one scale. None: no run has ground truth.
std::optional<Plot> path_plot(std::span<const PlottedRun> runs);

/// Every trial's value of a metric, a row per condition, with the quartiles as a box and the median
/// in it where there are at least three. None: no trial has a value.
std::optional<Plot> distribution_plot(const campaign::ScenarioResults& scenario,
                                      const std::string& metric);

}  // namespace tether::report
