#include "plots/plot_script.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <tether/report/size_report.h>

// Two areas over one axis of slowdowns: above, success; below, the margins of the metrics.
namespace tether::report {
namespace {

constexpr int kHeight_px = 600, kSplit_px = 350;  // from the top: where the upper area ends
constexpr int kTop_px = 44, kLeft_px = 92, kRight_px = 24, kBottom_px = 50, kGap_px = 46;
constexpr double kReachedLevel = 1.09, kMissedLevel = -0.09,
                 kScatter = 0.045;  // where flights are drawn
constexpr double kLeastMargin = -1.0, kMostMargin = 1.0;

// Flights at the same slowdown must not hide each other (as in distribution_plot).
double scattered(std::size_t flight) {
  constexpr double kGoldenRatio = 0.6180339887498949;
  const double turns = kGoldenRatio * static_cast<double>(flight + 1);
  return 2.0 * kScatter * (turns - std::floor(turns) - 0.5);
}

std::string axis_number(double value) {
  return fmt::format("{:.5g}", value);
}

std::string area_script(int from_px, int to_px) {
  return fmt::format("set tmargin at screen {:.5f}\nset bmargin at screen {:.5f}\n",
                     1.0 - static_cast<double>(from_px) / kHeight_px,
                     1.0 - static_cast<double>(to_px) / kHeight_px);
}

std::string y_label_script(const std::string& text) {
  return fmt::format("set label {} at screen {:.5f}, graph 0.5 center rotate textcolor {}\n",
                     quoted(text), 14.0 / kPlotWidth_px, gnuplot_colour(Ink::kForeground));
}

std::string tics_script(double least, double most, bool has_labels) {
  std::string tics;
  for (double decade = std::pow(10.0, std::floor(std::log10(least))); decade <= most;
       decade *= 10.0) {
    for (const double digit : {1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0}) {
      if (digit * decade < least * 0.999 || digit * decade > most * 1.001) continue;
      const std::string value = axis_number(digit * decade);
      tics +=
          fmt::format("{}'{}' {}", tics.empty() ? "" : ", ", has_labels ? value + " ×" : "", value);
    }
  }
  return "set xtics (" + tics + ")\n";
}

std::string vertical(double slowdown, const std::string& style, Ink ink) {
  return fmt::format("set arrow from {0},graph 0 to {0},graph 1 nohead {1} linecolor {2} back\n",
                     axis_number(slowdown), style, gnuplot_colour(ink));
}

std::string vertical_band(double low, double high, Ink ink) {
  return fmt::format(
      "set object rectangle from {},graph 0 to {},graph 1 fillcolor {} fillstyle solid 0.14 "
      "noborder back\n",
      axis_number(low), axis_number(high), gnuplot_colour(ink));
}

constexpr Ink kCurve = Ink::kSeries;
constexpr Ink kUnsynchronised = Ink::kAnchor;

Ink board_ink(std::size_t board) {
  return series_ink(1 + board % (kSeriesInks - 2));
}

// The marks that both areas share.
std::string marks_script(const SizeReport& report) {
  const sizing::Answer& answer = report.synchronised.answer;
  std::string script;
  if (!answer.is_below && !answer.is_above)
    script += vertical_band(std::max(answer.threshold.low, report.question.least),
                            std::min(answer.threshold.high, report.question.most), kCurve) +
              vertical(answer.threshold.estimate, "linewidth 2", kCurve);
  for (std::size_t i = 0; i < report.boards.size(); ++i) {
    const Board& board = report.boards[i];
    if (board.low) script += vertical_band(*board.low, *board.high, board_ink(i));
    script += vertical(board.slowdown, "linewidth 2 dashtype '-'", board_ink(i));
  }
  return script;
}

// Above the upper area, each in a row of its own, so that near boards do not hide each other's
// name.
std::string names_script(const SizeReport& report, double most) {
  std::string script;
  for (std::size_t i = 0; i < report.boards.size(); ++i) {
    const Board& board = report.boards[i];
    const bool is_right = board.slowdown > std::sqrt(most * report.question.least);
    script += fmt::format("set label {} at {},graph {:.3f} {} offset {},0 textcolor {}\n",
                          quoted(board.name), axis_number(board.slowdown),
                          0.30 - 0.065 * static_cast<double>(i % 4), is_right ? "right" : "left",
                          is_right ? "-0.6" : "0.6", gnuplot_colour(board_ink(i)));
  }
  return script;
}

void add_flights(Drawing& drawing, const SizedCondition& sized, const std::string& name, Ink ink,
                 bool is_reference) {
  DataBlock reached(name + "reached"), missed(name + "missed");
  for (std::size_t i = 0; i < sized.flights.size(); ++i) {
    const sizing::Flight& flight = sized.flights[i];
    (flight.reached ? reached : missed)
        .add(flight.slowdown, (flight.reached ? kReachedLevel : kMissedLevel) + scattered(i));
  }
  const std::string size = is_reference ? "pointsize 0.35" : "pointsize 0.55";
  drawing.add(reached, "with points pointtype 7 " + size, ink,
              is_reference ? "" : "flight, goal reached");
  drawing.add(missed, "with points pointtype 2 linewidth 1.5 " + size, ink,
              is_reference ? "" : "flight, goal missed");
}

void add_curve(Drawing& drawing, const SizedCondition& sized, const std::string& name, Ink ink,
               const std::string& title) {
  DataBlock line(name);
  for (const CurvePoint& point : sized.curve) line.add(point.slowdown, point.share.estimate);
  drawing.add(line, "with lines linewidth 2.5", ink, title);
}

// With intervals of the levels, where no curve fits.
void add_levels(Drawing& drawing, const SizeReport& report) {
  DataBlock levels("levels");
  const double confidence = report.question.confidence;
  for (const sizing::Level& level :
       sizing::levels_of(report.question, report.synchronised.flights, confidence)) {
    if (level.flights > 0)
      levels.add(level.middle(), level.share.estimate, level.share.low, level.share.high);
  }
  drawing.add(levels, "with yerrorbars pointtype 5 pointsize 0.4", kCurve,
              fmt::format("share of near slowdowns, {:.4g} % interval", 100.0 * confidence));
}

std::string success_script(const SizeReport& report) {
  const SizedCondition& sized = report.synchronised;
  Drawing drawing;
  if (sized.answer.basis == sizing::Basis::kLevels) {
    add_levels(drawing, report);
  } else {
    // The band as a closed curve: its lower edge forth, its upper edge back.
    DataBlock band("band");
    for (const CurvePoint& point : sized.curve) band.add(point.slowdown, point.share.low);
    for (auto point = sized.curve.rbegin(); point != sized.curve.rend(); ++point)
      band.add(point->slowdown, point->share.high);
    drawing.add(band, "with filledcurves closed", kCurve, "", "fillstyle solid 0.2 noborder");
    add_curve(drawing, sized, "curve", kCurve, "success");
  }
  if (report.unsynchronised) {
    add_curve(drawing, *report.unsynchronised, "other", kUnsynchronised, "without synchronisation");
    add_flights(drawing, *report.unsynchronised, "other", kUnsynchronised, true);
  }
  DataBlock wanted("wanted");
  wanted.add(report.question.least, report.question.success);
  wanted.add(report.question.most, report.question.success);
  drawing.add(wanted, "with lines linewidth 1 dashtype '.'", Ink::kForeground, "");
  add_flights(drawing, sized, "own", kCurve, false);
  return drawing.script();
}

// The metrics that have margins, in the order of the trials.
std::vector<std::string> metrics_of(const SizedCondition& sized) {
  std::vector<std::string> names;
  for (const campaign::TrialResult& trial : sized.trials)
    for (const campaign::MetricValue& metric : trial.metrics)
      if (margin_of(metric) && std::ranges::find(names, metric.name) == names.end())
        names.push_back(metric.name);
  return names;
}

std::string margins_script(const SizeReport& report, const std::vector<std::string>& metrics) {
  Drawing drawing;
  DataBlock limit("limit");
  limit.add(report.question.least, 0.0);
  limit.add(report.question.most, 0.0);
  drawing.add(limit, "with lines linewidth 1 dashtype '.'", Ink::kForeground, "");
  for (std::size_t i = 0; i < metrics.size(); ++i) {
    DataBlock points(fmt::format("margin{}", i));
    std::string label = metrics[i];
    for (std::size_t k = 0; k < report.synchronised.trials.size(); ++k) {
      const campaign::MetricValue* metric = report.synchronised.trials[k].find_metric(metrics[i]);
      const std::optional<double> margin = metric ? margin_of(*metric) : std::nullopt;
      if (!margin) continue;
      label = metric->label;
      points.add(report.synchronised.flights[k].slowdown,
                 std::clamp(*margin, kLeastMargin, kMostMargin));
    }
    drawing.add(points, fmt::format("with points pointtype {} pointsize 0.5", 7 + 2 * (i % 4)),
                series_ink(2 + i), label);
  }
  return drawing.script();
}

}  // namespace

Plot size_plot(const SizeReport& report) {
  const sizing::Question& question = report.question;
  const double margin = std::pow(question.most / question.least, 0.02);
  const double least = question.least / margin, most = question.most * margin;
  const std::vector<std::string> metrics = metrics_of(report.synchronised);
  const std::string x_label = fmt::format("slower than “{}”", report.synchronised.condition);
  Frame frame{.height_px = metrics.empty() ? kSplit_px + kBottom_px : kHeight_px,
              .left_px = kLeft_px,
              .right_px = kRight_px,
              .top_px = kTop_px,
              .bottom_px = kBottom_px,
              .x_label = metrics.empty() ? x_label : ""};
  std::string script = frame_script(frame) + "set logscale x\n" + range_script("x", least, most) +
                       tics_script(least, most, metrics.empty()) + marks_script(report);
  const std::string success_axis =
      range_script("y", -0.18, 1.18) +
      "set ytics ('0 %%' 0, '25 %%' 0.25, '50 %%' 0.5, '75 %%' 0.75, '100 %%' 1)\n" +
      y_label_script("goal reached");
  const Plot title{{},
                   fmt::format("Flights of {} that reach the goal, over the slowdown of the "
                               "computer",
                               report.scenario)};
  const std::string upper = success_axis + names_script(report, most);
  if (metrics.empty()) return {script + upper + success_script(report), title.title};
  script += "set multiplot\n" + area_script(kTop_px, kSplit_px) + upper + success_script(report);
  script += area_script(kSplit_px + kGap_px, kHeight_px - kBottom_px) + "unset label\n" +
            tics_script(least, most, true) + range_script("y", -1.1, 1.1) +
            "set ytics ('−100 %%' -1, '−50 %%' -0.5, 'limit' 0, '50 %%' 0.5, '100 %%' 1)\n" +
            y_label_script("margin") +
            fmt::format("set key at screen {:.5f}, screen {:.5f} right top\n",
                        1.0 - static_cast<double>(kRight_px) / kPlotWidth_px,
                        1.0 - static_cast<double>(kSplit_px + 14) / kHeight_px) +
            fmt::format("set label {} at graph 0.5, screen {:.5f} center textcolor {}\n",
                        quoted(x_label), 13.0 / kHeight_px, gnuplot_colour(Ink::kForeground)) +
            margins_script(report, metrics) + "unset multiplot\n";
  return {script, title.title};
}

}  // namespace tether::report
