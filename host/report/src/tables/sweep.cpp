#include "plots/plot_script.h"
#include "tables/report_format.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include <tether/campaign/campaign_results.h>
#include <tether/report/report.h>
#include <tether/sizing/sizing.h>

// Each point of a sweep is a scenario's results. A series takes those points that differ in the
// key of the x axis only. A place on that axis is the key's value or, if one of the values is no
// number, its index: names have no order, and no line joins them.
namespace tether::report {
namespace {

constexpr double kConfidence = 0.95;

std::string short_value(const std::string& value) {
  return value.find('/') == std::string::npos ? value
                                              : std::filesystem::path(value).stem().string();
}

std::string last_part(const std::string& key) {
  return key.substr(key.rfind('.') + 1);
}

/// Of distinct flights.
campaign::Count reached_of(const campaign::ConditionResults& results) {
  const auto distinct = campaign::distinct_flights(results.trials);
  const auto reached = std::ranges::count(distinct, campaign::Outcome::kGoalReached,
                                          &campaign::TrialResult::outcome);
  return {static_cast<std::size_t>(reached), distinct.size()};
}

sizing::Share reached_share(const campaign::ConditionResults& results) {
  const campaign::Count reached = reached_of(results);
  return sizing::exact_share(reached.of_them, reached.all, kConfidence);
}

/// Label and unit of a metric, from any trial; nullptr if there is none.
const campaign::MetricValue* find_metric(const Sweep& sweep, const std::string& name) {
  for (const campaign::ScenarioResults* point : sweep.points)
    if (const campaign::MetricValue* found = point->find_metric(name)) return found;
  return nullptr;
}

// The x axis.
struct Axis {
  std::vector<std::size_t> keys;  ///< indices into the settings: several if they vary together
  std::string label;
  std::vector<std::string> values;  ///< distinct, in the order of the points
  std::vector<double> places;       ///< of each value
  bool is_numeric = true;
};

std::string value_of(const campaign::ScenarioResults& point, const std::vector<std::size_t>& keys) {
  std::string text;
  for (const std::size_t key : keys) text += (text.empty() ? "" : ", ") + point.settings[key].value;
  return text;
}

std::vector<std::string> distinct_values(const Sweep& sweep, const std::vector<std::size_t>& keys) {
  std::vector<std::string> values;
  for (const campaign::ScenarioResults* point : sweep.points) {
    const std::string value = value_of(*point, keys);
    if (std::ranges::find(values, value) == values.end()) values.push_back(value);
  }
  return values;
}

Axis axis_of(const Sweep& sweep) {
  const auto& settings = sweep.points.front()->settings;
  Axis axis;
  std::vector<std::size_t> varied;
  for (std::size_t key = 0; key < settings.size(); ++key) {
    std::vector<std::string> values = distinct_values(sweep, {key});
    if (values.size() > 1) varied.push_back(key);
    if (values.size() <= axis.values.size()) continue;
    axis = {{key}, settings[key].key, std::move(values), {}, true};
  }
  // Of keys that vary together, none can be said to make the difference.
  if (varied.size() > 1 && axis.values.size() == sweep.points.size()) {
    axis = {varied, "", distinct_values(sweep, varied), {}, true};
    for (const std::size_t key : varied)
      axis.label += (axis.label.empty() ? "" : ", ") + settings[key].key;
  }
  for (const std::string& value : axis.values) {
    const auto number = number_in(value);
    axis.is_numeric = axis.is_numeric && number.has_value();
    axis.places.push_back(number.value_or(0.0));
  }
  for (std::size_t i = 0; !axis.is_numeric && i < axis.places.size(); ++i)
    axis.places[i] = static_cast<double>(i);
  return axis;
}

double place_of(const Axis& axis, const campaign::ScenarioResults& point) {
  const auto found = std::ranges::find(axis.values, value_of(point, axis.keys));
  return axis.places[static_cast<std::size_t>(found - axis.values.begin())];
}

std::string axis_script(const Axis& axis) {
  const auto [least, most] = std::ranges::minmax(axis.places);
  const double margin = std::max(0.04 * (most - least), 1e-6 * std::max(1.0, std::abs(most)));
  // A tic at each value that was flown.
  std::string tics;
  for (std::size_t i = 0; i < axis.values.size(); ++i)
    tics += fmt::format("{}{} {:.9g}", i > 0 ? ", " : "", quoted(short_value(axis.values[i])),
                        axis.places[i]);
  return range_script("x", least - margin, most + margin) + "set xtics (" + tics + ")\n";
}

struct Series {
  std::string title;
  std::vector<std::pair<double, const campaign::ConditionResults*>> points;  ///< by place
};

std::vector<Series> series_of(const Sweep& sweep, const Axis& axis) {
  std::vector<Series> all;
  for (const campaign::ScenarioResults* point : sweep.points) {
    std::string others;
    for (std::size_t key = 0; key < point->settings.size(); ++key) {
      const bool is_shown =
          std::ranges::count(axis.keys, key) == 0 && sweep.points.size() > axis.values.size();
      if (is_shown)
        others += fmt::format(", {} {}", last_part(point->settings[key].key),
                              short_value(point->settings[key].value));
    }
    for (const campaign::ConditionResults& condition : point->conditions) {
      const std::string title = condition.condition + others;
      auto found = std::ranges::find(all, title, &Series::title);
      if (found == all.end()) found = all.insert(all.end(), {title, {}});
      if (reached_of(condition).all > 0)
        found->points.emplace_back(place_of(axis, *point), &condition);
    }
  }
  for (Series& series : all)
    std::ranges::stable_sort(series.points, {}, [](const auto& point) { return point.first; });
  return all;
}

Frame frame_of(const Axis& axis, std::size_t series, const std::string& y_label) {
  Frame frame{.height_px = 300, .x_label = axis.label, .y_label = y_label};
  frame.key_rows = static_cast<int>((series + 2) / 3);
  frame.top_px = 24 + 20 * frame.key_rows;
  frame.height_px += 20 * frame.key_rows;
  return frame;
}

std::string title_of(const Sweep& sweep, const Axis& axis, const std::string& what) {
  return fmt::format("{} of {} over {}", what, sweep.scenario, axis.label);
}

}  // namespace

std::vector<Sweep> sweeps_of(const campaign::CampaignResults& results) {
  std::vector<Sweep> sweeps;
  for (const campaign::ScenarioResults& scenario : results.scenarios) {
    if (scenario.swept_from.empty()) continue;
    auto found = std::ranges::find(sweeps, scenario.swept_from, &Sweep::scenario);
    if (found == sweeps.end()) found = sweeps.insert(sweeps.end(), {scenario.swept_from, {}});
    found->points.push_back(&scenario);
  }
  return sweeps;
}

Table sweep_table(const Sweep& sweep) {
  const campaign::ScenarioResults& first = *sweep.points.front();
  Table table;
  table.title = fmt::format("Sweep of {}", sweep.scenario);
  std::vector<std::string> headings;
  for (const campaign::Setting& setting : first.settings) headings.push_back(setting.key);
  table.text_columns = headings.size() + 1;
  headings.insert(headings.end(), {"Condition", "Goal reached", "95 % interval"});
  for (const std::string& name : first.metrics) {
    const campaign::MetricValue* metric = find_metric(sweep, name);
    headings.push_back(metric != nullptr ? with_unit(metric->label, metric->unit) : name);
    headings.emplace_back("95 % interval");
  }
  table.headings = {single_headings(headings)};
  for (const campaign::ScenarioResults* point : sweep.points) {
    for (const campaign::ConditionResults& condition : point->conditions) {
      std::vector<std::string> row;
      for (const campaign::Setting& setting : point->settings)
        row.push_back(short_value(setting.value));
      row.push_back(condition.condition);
      row.push_back(fmt::format("{} of {}", condition.count(campaign::Outcome::kGoalReached),
                                condition.trials.size()));
      row.emplace_back(kNone);
      if (reached_of(condition).all > 0) {
        const sizing::Share share = reached_share(condition);
        row.back() = fmt::format("{:.0f} to {:.0f} %", 100.0 * share.low, 100.0 * share.high);
      }
      for (const std::string& name : first.metrics) {
        const campaign::Summary summary = campaign::summarise(condition.values(name));
        row.push_back(summary.n > 0 ? decimals(summary.mean) : kNone);
        row.push_back(interval(summary.ci95));
      }
      table.rows.push_back(std::move(row));
    }
  }
  return table;
}

Table sweep_tests_table(const Sweep& sweep) {
  const Axis axis = axis_of(sweep);
  Table table;
  table.title = fmt::format("Differences between the values of {}", axis.label);
  table.text_columns = 3;
  table.headings = {single_headings(
      {"Condition", "Value", "Other value", "Goal reached", "Other", "p, corrected"})};
  struct Pair {
    const Series* series;
    std::size_t a, b;
  };
  const std::vector<Series> all = series_of(sweep, axis);
  std::vector<Pair> pairs;
  std::vector<double> p_values;
  for (const Series& series : all)
    for (std::size_t b = 1; b < series.points.size(); ++b)
      for (std::size_t a = 0; a < b; ++a) {
        pairs.push_back({&series, a, b});
        p_values.push_back(campaign::fisher_exact(reached_of(*series.points[a].second),
                                                  reached_of(*series.points[b].second)));
      }
  const auto value_at = [&](double place) {
    const auto at = std::ranges::find(axis.places, place) - axis.places.begin();
    return short_value(axis.values[static_cast<std::size_t>(at)]);
  };
  const auto count_text = [](const campaign::ConditionResults& results) {
    const campaign::Count reached = reached_of(results);
    return fmt::format("{} of {}", reached.of_them, reached.all);
  };
  const std::vector<double> corrected = campaign::holm(p_values);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto& [place_a, a] = pairs[i].series->points[pairs[i].a];
    const auto& [place_b, b] = pairs[i].series->points[pairs[i].b];
    table.rows.push_back({pairs[i].series->title, value_at(place_a), value_at(place_b),
                          count_text(*a), count_text(*b), p_value(corrected[i])});
  }
  table.notes = {
      "Fisher's exact test of the numbers of different flights that reach the goal, "
      "corrected for all rows by Holm's method. Below 0.05, chance does not explain the "
      "difference."};
  return table;
}

std::optional<Plot> sweep_plot(const Sweep& sweep) {
  const Axis axis = axis_of(sweep);
  const std::vector<Series> all = series_of(sweep, axis);
  Drawing drawing;
  for (std::size_t i = 0; i < all.size(); ++i) {
    DataBlock shares(fmt::format("share{}", i));
    for (const auto& [place, results] : all[i].points) {
      const sizing::Share share = reached_share(*results);
      shares.add(place, share.estimate, share.low, share.high);
    }
    drawing.add(shares,
                fmt::format("with {} pointtype 7 pointsize 0.6 linewidth 1.5",
                            axis.is_numeric ? "yerrorlines" : "yerrorbars"),
                series_ink(i), all[i].title);
  }
  if (drawing.empty()) return std::nullopt;
  return Plot{frame_script(frame_of(axis, all.size(), "goal reached")) + axis_script(axis) +
                  range_script("y", -0.05, 1.05) +
                  "set ytics ('0 %%' 0, '25 %%' 0.25, '50 %%' 0.5, '75 %%' 0.75, '100 %%' 1)\n" +
                  drawing.script(),
              title_of(sweep, axis, "Trials that reach the goal")};
}

std::optional<Plot> sweep_plot(const Sweep& sweep, const std::string& metric) {
  const Axis axis = axis_of(sweep);
  const std::vector<Series> all = series_of(sweep, axis);
  const campaign::MetricValue* value = find_metric(sweep, metric);
  if (value == nullptr) return std::nullopt;
  Drawing drawing;
  std::vector<double> drawn;
  for (std::size_t i = 0; i < all.size(); ++i) {
    DataBlock means(fmt::format("mean{}", i)), trials(fmt::format("trials{}", i));
    for (const auto& [place, results] : all[i].points) {
      const std::vector<double> values = results->values(metric);
      if (values.empty()) continue;
      means.add(place, campaign::summarise(values).mean);
      for (const double one : values) trials.add(place, one);
      drawn.insert(drawn.end(), values.begin(), values.end());
    }
    drawing.add(means,
                fmt::format("with {} pointtype 7 pointsize 0.7 linewidth 1.5",
                            axis.is_numeric ? "linespoints" : "points"),
                series_ink(i), all[i].title);
    drawing.add(trials, "with points pointtype 6 pointsize 0.4", series_ink(i), "");
  }
  if (drawing.empty()) return std::nullopt;
  if (value->max) drawn.push_back(*value->max);
  const auto [least, most] = std::ranges::minmax(drawn);
  const double low = least >= 0.0 ? 0.0 : least;
  const double span = most > low ? most - low : std::max(0.2 * std::abs(most), 0.5);
  const std::string y_label = with_unit(value->label, value->unit);
  std::string script = frame_script(frame_of(axis, all.size(), y_label)) + axis_script(axis) +
                       range_script("y", low - 0.03 * span, most + 0.05 * span);
  for (const std::optional<double>& limit : {value->max, value->min})
    if (limit)
      script += fmt::format(
          "set arrow from graph 0, first {0:.9g} to graph 1, first {0:.9g} nohead dashtype '.' "
          "linecolor {1} back\n",
          *limit, gnuplot_colour(Ink::kForeground));
  return Plot{script + drawing.script(), title_of(sweep, axis, y_label)};
}

}  // namespace tether::report
