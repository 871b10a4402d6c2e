#include "plots/verdict_picture.h"

#include "plots/shapes.h"
#include "plots/svg.h"
#include "tables/report_format.h"

#include <algorithm>

#include <fmt/format.h>

namespace tether::report {
namespace {

constexpr double kMostWidth_px = 560.0;  // alone on a page
constexpr double kPictureWidth = 420.0, kPictureRow = 46.0, kPictureTop = 34.0;
constexpr std::size_t kMostSigns = 200;  // more would not be seen

struct PictureRow {
  std::string label;
  const ConditionVerdict* condition;
};

/// One flight after the other: those that reached the goal, those that missed it, those that
/// failed.
std::string signs(const ConditionVerdict& condition, double y) {
  const std::size_t all = std::min(condition.flown + condition.failed, kMostSigns);
  const double step =
      std::min(18.0, kPictureWidth / static_cast<double>(std::max<std::size_t>(all, 1)));
  const double r = std::min(5.5, 0.42 * step);
  std::string svg;
  for (std::size_t i = 0; i < all; ++i) {
    const double x = step * (static_cast<double>(i) + 0.5);
    if (i < condition.reached)
      svg += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" {}/>\n", x, y, r,
                         fill_of(series_ink(0)));
    else if (i < condition.flown)
      svg += fmt::format(
          "<path d=\"M{0:.1f} {1:.1f}l{2:.1f} {2:.1f}m0 {3:.1f}l{3:.1f} {2:.1f}\" "
          "stroke-width=\"2.5\" {4}/>\n",
          x - r, y - r, 2.0 * r, -2.0 * r, stroke_of(series_ink(1)));
    else
      svg += fmt::format(
          "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" stroke-width=\"1.5\" {}/>\n", x, y,
          r - 0.5, stroke_of(Ink::kAnchor));
  }
  return svg;
}

bool has_bar(const ConditionVerdict& condition) {
  return condition.pace && !condition.pace->camera.empty() && condition.pace->median_s > 0.0;
}

/// "host: 24 ms, of it detect 100 %"
std::string bar_text(const PictureRow& row) {
  const Pace& pace = *row.condition->pace;
  std::string text = fmt::format("{}: {}", row.label, short_ms(pace.median_s));
  if (!pace.stages.empty())
    text += fmt::format(", of it {} {:.0f} %", pace.stages.front().stage,
                        100.0 * (1.0 - pace.waiting) * pace.stages.front().share);
  if (pace.waiting > 0.0) text += fmt::format(", waiting for cores {:.0f} %", 100.0 * pace.waiting);
  return text;
}

std::string bar(const PictureRow& row, double y, double px_per_s) {
  const Pace& pace = *row.condition->pace;
  const double own = 1.0 - pace.waiting;
  std::string svg = text_svg(0.0, y + 4.0, bar_text(row), "start", 13);
  double x = 0.0;
  for (std::size_t i = 0; i < pace.stages.size(); ++i) {
    const double width = px_per_s * pace.median_s * own * pace.stages[i].share;
    if (width < 0.5) break;  // the others take less
    svg += rectangle_svg(x, y + 12.0, width, 14.0, series_ink(i + 2));
    x += width;
  }
  if (pace.waiting > 0.0)
    svg += rectangle_svg(x, y + 12.0, px_per_s * pace.median_s * pace.waiting, 14.0, Ink::kMuted);
  svg += rectangle_svg(0.0, y + 18.0, std::max(1.0, px_per_s * pace.p95_s), 2.0, Ink::kForeground);
  if (pace.offered_hz)
    svg += fmt::format(
        "<path d=\"M{:.1f} {:.1f}v22\" stroke-width=\"2\" stroke-dasharray=\"4 3\" {}/>\n",
        px_per_s / *pace.offered_hz, y + 8.0, stroke_of(Ink::kForeground));
  return svg;
}

std::vector<PictureRow> picture_rows(const std::vector<std::vector<Verdict>>& groups) {
  std::vector<PictureRow> rows;
  for (const std::vector<Verdict>& points : groups)
    for (const Verdict& point : points)
      for (const ConditionVerdict& condition : point.conditions) {
        std::string label = condition.condition;
        if (!point.point.empty()) label = point.point + ", " + label;
        if (groups.size() > 1) label = point.scenario + ", " + label;
        if (condition.flown + condition.failed > 0) rows.push_back({std::move(label), &condition});
      }
  return rows;
}

/// @param words that a screen reader says in place of the picture
std::string drawing_of(const std::string& title, const std::string& words, const std::string& body,
                       double height) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" viewBox=\"0 0 {:.0f} {:.0f}\" "
      "style=\"max-width:{:.0f}px\" aria-label=\"{}\" font-family=\"sans-serif\">\n{}{}</svg>\n",
      kPictureWidth, height, kMostWidth_px, escape_markup(title + words),
      text_svg(0.0, 15.0, title, "start", 13), body);
}

}  // namespace

bool has_bars(const std::vector<std::vector<Verdict>>& groups) {
  return std::ranges::any_of(picture_rows(groups),
                             [](const PictureRow& row) { return has_bar(*row.condition); });
}

std::string verdict_picture(const std::vector<std::vector<Verdict>>& groups) {
  const std::vector<PictureRow> rows = picture_rows(groups);
  if (rows.empty()) return "";
  std::string flights, words, bars_words;
  double y = kPictureTop, most_s = 0.0;
  for (const PictureRow& row : rows) {
    flights += text_svg(0.0, y + 4.0, fmt::format("{}: {}", row.label, name(*row.condition)),
                        "start", 13) +
               signs(*row.condition, y + 20.0);
    words += fmt::format("; {}: {}, {} of {} reach the goal", row.label, name(*row.condition),
                         row.condition->reached, row.condition->flown);
    y += kPictureRow;
    if (!has_bar(*row.condition)) continue;
    bars_words += "; " + bar_text(row);
    const Pace& pace = *row.condition->pace;
    most_s = std::max(
        {most_s, pace.median_s, pace.p95_s, pace.offered_hz ? 1.0 / *pace.offered_hz : 0.0});
  }
  std::string drawings = drawing_of("Flights of each condition", words, flights, y);
  if (!has_bars(groups)) return drawings;
  std::string bars;
  y = kPictureTop;
  for (const PictureRow& row : rows) {
    if (has_bar(*row.condition)) bars += bar(row, y, (kPictureWidth - 4.0) / most_s);
    y += kPictureRow;
  }
  return drawings + drawing_of("Computing time per image", bars_words, bars, y);
}

}  // namespace tether::report
