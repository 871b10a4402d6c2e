#include "plots/mission_timeline.h"

#include "plots/shapes.h"
#include "plots/svg.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tether::report {
namespace {

constexpr double kWidth = 960.0, kLeft = 330.0, kRight = 850.0, kRow = 22.0, kTop = 10.0;
constexpr Ink kTask = Ink::kSeries;
const Ink kMissed = series_ink(1);
const Ink kMet = series_ink(2);

std::string duration_bar(double x, double y, double width, double height, Ink ink) {
  return rectangle_svg(x, y, std::max(width, 1.0), height, ink);
}

std::string text(double x, double y, std::string_view anchor, const std::string& words) {
  return text_svg(x, y, words, anchor);
}

/// At most `most` characters.
std::string shortened(const std::string& words, std::size_t most = 52) {
  return words.size() <= most ? words : words.substr(0, most - 3) + "...";
}

class Timeline {
 public:
  Timeline(const campaign::TrialResult& trial, const std::string& uav) : uav_(uav) {
    for (const judge::TaskSpan& task : trial.tasks)
      if (task.uav == uav) reach(task.to);
    for (const judge::ClauseVerdict& clause : trial.clauses)
      for (const auto& time : {clause.to, clause.deadline})
        if (clause.uav == uav && time) reach(*time);
  }

  void draw(const judge::TaskSpan& task) {
    body_ += text(kLeft - 8, baseline(), "end", shortened(task.task));
    body_ += duration_bar(x(task.from), y_ + 4, x(task.to) - x(task.from), kRow - 8, kTask);
    body_ += text(kRight + 8, baseline(), "start", shortened(task.status, 14));
    y_ += kRow;
  }

  void draw(const judge::ClauseVerdict& clause) {
    const Ink ink = clause.met ? kMet : kMissed;
    body_ += text(kLeft - 8, baseline(), "end", shortened(clause.name));
    if (clause.from && clause.to)
      body_ += duration_bar(x(*clause.from), y_ + 9, x(*clause.to) - x(*clause.from), 4, ink);
    body_ += drain(clause.margins);
    if (clause.deadline)
      body_ += duration_bar(x(*clause.deadline) - 1, y_ + 2, 2, kRow - 4, Ink::kForeground);
    if (clause.decided_at)
      body_ += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"5\" {}/>\n",
                           x(*clause.decided_at), y_ + 11, fill_of(ink));
    body_ += text(kRight + 8, baseline(), "start",
                  clause.margin ? fmt::format("{:+.3g} {}", *clause.margin, clause.unit)
                                : std::string(clause.met ? "met" : "missed"));
    y_ += kRow;
  }

  std::string svg() {
    body_ += time_axis_svg(kLeft, kRight, kTop, y_, end_s_);
    const std::string title = fmt::format("Tasks and clauses of {} over simulated time", uav_);
    return fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" viewBox=\"0 0 {:.0f} {:.0f}\" "
        "aria-label=\"{}\">\n{}</svg>\n",
        kWidth, y_ + 42, escape_markup(title), body_);
  }

 private:
  /// The margin over time: from its largest value at the top of the lane to 0 in the middle; what
  /// is missed lies below.
  std::string drain(const std::vector<judge::MarginAt>& margins) const {
    double largest = 0.0;
    for (const judge::MarginAt& margin : margins)
      largest = std::max(largest, std::abs(margin.margin));
    if (margins.size() < 2 || largest == 0.0) return "";
    std::string points;
    for (const judge::MarginAt& margin : margins)
      points += fmt::format("{:.1f},{:.1f} ", x(margin.at),
                            y_ + kRow / 2 - (kRow / 2 - 1) * margin.margin / largest);
    points.pop_back();
    return fmt::format(
        "<polyline points=\"{}\" style=\"fill:none;stroke-width:1.5\" class=\"tp-stroke-{}\"/>\n",
        points, static_cast<std::size_t>(Ink::kForeground));
  }

  void reach(SimTime time) { end_s_ = std::max(end_s_, to_seconds(time)); }
  double x(SimTime time) const {
    return kLeft + (kRight - kLeft) * to_seconds(time) / std::max(end_s_, 1e-9);
  }
  double baseline() const { return y_ + 15; }

  std::string uav_;
  double end_s_ = 0.0;
  double y_ = kTop;
  std::string body_;
};

}  // namespace

std::string mission_timeline(const campaign::TrialResult& trial, const std::string& uav) {
  if (std::ranges::count(trial.clauses, uav, &judge::ClauseVerdict::uav) == 0) return "";
  Timeline timeline(trial, uav);
  for (const judge::TaskSpan& task : trial.tasks)
    if (task.uav == uav) timeline.draw(task);
  for (const judge::ClauseVerdict& clause : trial.clauses)
    if (clause.uav == uav) timeline.draw(clause);
  return timeline.svg();
}

}  // namespace tether::report
