#include "plots/plot_script.h"
#include "tables/report_format.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <tether/stats/sample_statistics.h>

namespace tether::report {
namespace {

constexpr std::size_t kLeastForBox = 3;
constexpr int kRow_px = 46;

struct Row {
  std::string condition;
  std::size_t planned = 0;
  std::size_t flown = 0;  ///< trials with a value
  std::vector<double> values;
};

// Points with the same value must not hide each other. The golden ratio spreads their heights
// evenly and is the same every time.
double jitter(std::size_t trial) {
  constexpr double kGoldenRatio = 0.6180339887498949, kSpread = 0.36;
  const double turns = kGoldenRatio * static_cast<double>(trial + 1);
  return kSpread * (turns - std::floor(turns) - 0.5);
}

std::string box_script(const Row& row, std::size_t index) {
  if (row.values.size() < kLeastForBox) return "";
  std::vector<double> sorted = row.values;
  std::sort(sorted.begin(), sorted.end());
  const double y = static_cast<double>(index + 1), half = 0.3;
  const std::string colour = gnuplot_colour(series_ink(index));
  return fmt::format(
             "set object rectangle from {0:.7g},{1:.7g} to {2:.7g},{3:.7g} fillcolor {4} "
             "fillstyle solid 0.16 border linecolor {4} back\n",
             stats::quantile(sorted, 0.25), y - half, stats::quantile(sorted, 0.75), y + half,
             colour) +
         fmt::format(
             "set arrow from {0:.7g},{1:.7g} to {0:.7g},{2:.7g} nohead linewidth 3 linecolor {3} "
             "back\n",
             stats::quantile(sorted, 0.5), y - half, y + half, colour);
}

std::string row_label(const Row& row) {
  if (row.flown == row.planned) return row.condition;
  return fmt::format("{} ({} of {})", row.condition, row.flown, row.planned);
}

std::string rows_script(const std::vector<Row>& rows) {
  std::string tics;
  for (std::size_t i = 0; i < rows.size(); ++i)
    tics += fmt::format("{}{} {}", i > 0 ? ", " : "", quoted(row_label(rows[i])), i + 1);
  // The first row on top.
  return fmt::format("set ytics ({}) scale 0\n", tics) +
         range_script("y", static_cast<double>(rows.size()) + 0.5, 0.5) + "set grid noytics\n";
}

std::string values_range(const std::vector<Row>& rows, std::optional<double> limit) {
  std::vector<double> all;
  if (limit) all.push_back(*limit);
  for (const Row& row : rows) all.insert(all.end(), row.values.begin(), row.values.end());
  const auto [least, largest] = std::minmax_element(all.begin(), all.end());
  double low = *least, high = *largest;
  // Errors and times are easier to compare if the axis begins at zero.
  if (low >= 0.0 && low < 0.5 * high) low = 0.0;
  const double span = high > low ? high - low : std::max(0.2 * std::abs(high), 0.5);
  return range_script("x", low - 0.03 * span, high + 0.05 * span);
}

// Letters of the font are about 7.5 px wide.
int left_margin_px(const std::vector<Row>& rows) {
  std::size_t longest = 0;
  for (const Row& row : rows) longest = std::max(longest, row_label(row).size());
  return std::clamp(static_cast<int>(7.5 * static_cast<double>(longest)) + 24, 60, 340);
}

std::vector<Row> rows_of(const campaign::ScenarioResults& scenario, const std::string& metric) {
  std::vector<Row> rows;
  for (const campaign::ConditionResults& condition : scenario.conditions) {
    std::vector<double> values = condition.values(metric);
    const std::size_t flown = values.size();
    rows.push_back({condition.condition, condition.planned, flown, std::move(values)});
  }
  return rows;
}

/// The rows of a clause: of each trial, what `values_of` takes from the verdict on it.
template <class ValuesOf>
std::vector<Row> rows_of(const campaign::ScenarioResults& scenario,
                         const judge::ClauseVerdict& clause, const ValuesOf& values_of) {
  std::vector<Row> rows;
  for (const campaign::ConditionResults& condition : scenario.conditions) {
    Row& row = rows.emplace_back(Row{condition.condition, condition.planned, 0, {}});
    for (const campaign::TrialResult& trial : condition.trials)
      for (const judge::ClauseVerdict& own : trial.clauses) {
        if (own.uav != clause.uav || own.name != clause.name) continue;
        const std::vector<double>& values = values_of(own);
        row.flown += values.empty() ? 0U : 1U;
        row.values.insert(row.values.end(), values.begin(), values.end());
      }
  }
  return rows;
}

/// `limit`: a line there parts what is met from what is missed.
std::optional<Plot> plot_of(const std::vector<Row>& rows, const std::string& label,
                            const std::string& scenario, std::optional<double> limit) {
  if (std::ranges::all_of(rows, &std::vector<double>::empty, &Row::values)) return std::nullopt;
  Frame frame{.left_px = left_margin_px(rows), .top_px = 10, .x_label = label};
  frame.height_px = frame.top_px + frame.bottom_px + kRow_px * static_cast<int>(rows.size());
  std::string script = frame_script(frame) + values_range(rows, limit) + rows_script(rows);
  if (limit)
    script += fmt::format(
        "set arrow from {0:.7g},graph 0 to {0:.7g},graph 1 nohead linecolor {1} "
        "back\n",
        *limit, gnuplot_colour(Ink::kForeground));
  Drawing drawing;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    script += box_script(rows[i], i);
    DataBlock points(fmt::format("trials{}", i));
    for (std::size_t k = 0; k < rows[i].values.size(); ++k)
      points.add(rows[i].values[k], static_cast<double>(i + 1) + jitter(k));
    drawing.add(points, "with points pointtype 7 pointsize 0.55", series_ink(i), "");
  }
  return Plot{script + drawing.script(),
              fmt::format("{} of all trials of {}, by condition", label, scenario)};
}

}  // namespace

std::optional<Plot> distribution_plot(const campaign::ScenarioResults& scenario,
                                      const std::string& metric) {
  const campaign::MetricValue* value = scenario.find_metric(metric);
  if (value == nullptr) return std::nullopt;
  return plot_of(rows_of(scenario, metric), with_unit(value->label, value->unit), scenario.scenario,
                 std::nullopt);
}

std::optional<Plot> margin_plot(const campaign::ScenarioResults& scenario,
                                const judge::ClauseVerdict& clause) {
  const auto rows = rows_of(scenario, clause, [](const judge::ClauseVerdict& own) {
    return own.margin ? std::vector{*own.margin} : std::vector<double>{};
  });
  return plot_of(rows, with_unit("Margin of " + clause.name, clause.unit), scenario.scenario, 0.0);
}

std::optional<Plot> times_plot(const campaign::ScenarioResults& scenario,
                               const judge::ClauseVerdict& clause) {
  const auto rows = rows_of(scenario, clause, std::mem_fn(&judge::ClauseVerdict::quantiles));
  return plot_of(rows, with_unit(clause.name, clause.unit), scenario.scenario, clause.limit);
}

}  // namespace tether::report
