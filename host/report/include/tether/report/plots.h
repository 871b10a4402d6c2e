#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include <tether/campaign/campaign_results.h>
#include <tether/record/reader.h>

/// Plots of runs and campaigns as gnuplot scripts with inline data. Pure functions: equal arguments
/// give equal scripts. Long records are thinned, so that each drawing stays below 300 kB.
namespace tether::report {

/// A script for gnuplot.
struct Plot {
  std::string script;
  std::string title;  ///< one line; also for screen readers
};

/// A run in a plot.
struct PlottedRun {
  const record::Record* record = nullptr;
  std::string uav;
  std::string label;       ///< in the legend: the condition
  std::size_t series = 0;  ///< selects the colour: index of the condition in its scenario
};

enum class Extent {
  kWhole,
  kFirstInteractions,  ///< the first 20: the plot of a whole run is nearly a straight line
};

/// Simulated and execution time over wall time, with marks for interactions (paper, Fig. 4). In
/// free running, there is only ST. None if fewer than two interactions of that UAV have wall times.
std::optional<Plot> timeline_plot(const PlottedRun& run, Extent extent);

/// The lag ε = ET − ST of each request when it arrived, over ST. None in free running, and with
/// fewer than two interactions.
std::optional<Plot> lag_plot(const PlottedRun& run);

/// Height [m] and speed [m/s] of a UAV over ST. None with fewer than two points of ground truth.
std::optional<Plot> motion_plot(const PlottedRun& run);

/// Paths, seen from above, with ticks for the heading, start and end, and the first run's anchors
/// to scale (paper, Figs. 6, 7). A dashed line is the dead reckoning of the SUT from the true
/// start, if the SUT recorded it. Both axes have the same scale. None if no run has ground truth.
std::optional<Plot> path_plot(std::span<const PlottedRun> runs);

/// The values of a metric in all trials, with a row per condition. At least three trials have a box
/// of their quartiles with the median. None if no trial has a value.
std::optional<Plot> distribution_plot(const campaign::ScenarioResults& scenario,
                                      const std::string& metric);

/// The same for the margins of a clause of the missions, with a line at 0: what is below is missed.
std::optional<Plot> margin_plot(const campaign::ScenarioResults& scenario,
                                const judge::ClauseVerdict& clause);

/// The same for the times of a clause on commands or reads, such as reaction times, with a line at
/// its limit: the quantiles of each trial. None if no trial has such times.
std::optional<Plot> times_plot(const campaign::ScenarioResults& scenario,
                               const judge::ClauseVerdict& clause);

/// Draws a plot as SVG 1.1 with a style sheet for light and dark backgrounds, by the reader's
/// preference. Equal plots give equal files.
/// @param program looked for beside this program's file, then in PATH.
/// @throws Error(kSetup) if it is missing (subject: `program`), or fails to draw (subject: the
/// plot's title).
std::string draw_svg(const Plot& plot, const std::string& program = "gnuplot");

}  // namespace tether::report
