#include "plots/plot_script.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <tether/record/reader.h>
#include <tether/uav/math.h>

// The paths of several runs in one plot. Each run is reduced to a Way (path, yaw, dead reckoning).
// The plot is as large as all ways and anchors need, with the same scale on both axes.
namespace tether::report {
namespace {

constexpr std::size_t kPoints = 800;  // of a path
constexpr std::size_t kTicks = 20;
constexpr int kCirclePoints = 48;

struct Point {
  double x_m = 0.0, y_m = 0.0;
};

struct Bounds {
  double left_m = std::numeric_limits<double>::infinity();
  double right_m = -std::numeric_limits<double>::infinity();
  double bottom_m = left_m, top_m = right_m;

  void add(const Point& p) {
    left_m = std::min(left_m, p.x_m);
    right_m = std::max(right_m, p.x_m);
    bottom_m = std::min(bottom_m, p.y_m);
    top_m = std::max(top_m, p.y_m);
  }
  double width_m() const { return right_m - left_m; }
  double height_m() const { return top_m - bottom_m; }
};

struct Way {
  std::vector<Point> path;
  std::vector<double> yaw_rad;               // for each of `path`
  std::vector<std::vector<Point>> odometry;  // of each task
};

double yaw_of(const double (&q)[4]) {
  return uav::yaw_rad({q[0], q[1], q[2], q[3]});
}

Point placed(const Point& origin, double yaw_rad, double x_m, double y_m) {
  return {origin.x_m + std::cos(yaw_rad) * x_m - std::sin(yaw_rad) * y_m,
          origin.y_m + std::sin(yaw_rad) * x_m + std::cos(yaw_rad) * y_m};
}

// Data of the runs.

/// A pose in a plane.
struct Pose {
  Point p;
  double yaw_rad = 0.0;
};

std::optional<Pose> odometry_of(const nlohmann::json& note) {
  const auto number = [&](const char* key) -> std::optional<double> {
    const auto found = note.find(key);
    return found != note.end() && found->is_number() ? std::optional(found->get<double>())
                                                     : std::nullopt;
  };
  const auto x = number("x_m"), y = number("y_m");
  if (!x || !y) return std::nullopt;
  return Pose{{*x, *y}, number("yaw_rad").value_or(0.0)};
}

/// Where the frame of odometry is, whose first note is this one.
Pose odometry_frame(const Pose& first, const record::GroundTruth& truth) {
  const double yaw_rad = yaw_of(truth.q_WB) - first.yaw_rad;
  return {placed({truth.p_WB_m[0], truth.p_WB_m[1]}, yaw_rad, -first.p.x_m, -first.p.y_m), yaw_rad};
}

/// Each task has odometry of its own, which begins where the UAV truly is then.
void add_odometry(Way& way, const PlottedRun& run,
                  const std::vector<const record::GroundTruth*>& truths) {
  Pose frame;
  bool begins = true;
  for (const auto& [at, order, note] : run.record->annotations) {
    if (note.uav != run.uav) continue;
    const auto json = nlohmann::json::parse(note.json, nullptr, false);
    if (!json.is_object()) continue;
    const bool is_of_task = note.topic == "task" || note.topic == "mission";
    if (is_of_task && json.value("event", nlohmann::json()) == "start") begins = true;
    if (note.topic != "odometry") continue;
    const std::optional<Pose> pose = odometry_of(json);
    if (!pose) continue;
    if (std::exchange(begins, false)) {
      const auto after = std::ranges::upper_bound(truths, at, {}, &record::GroundTruth::at);
      frame = odometry_frame(*pose, **(after == truths.begin() ? after : std::prev(after)));
      way.odometry.emplace_back();
    }
    way.odometry.back().push_back(placed(frame.p, frame.yaw_rad, pose->p.x_m, pose->p.y_m));
  }
}

Way way_of(const PlottedRun& run) {
  std::vector<const record::GroundTruth*> truths;
  for (const auto& logged : run.record->ground_truth) {
    if (logged.message.uav == run.uav) truths.push_back(&logged.message);
  }
  Way way;
  for (const std::size_t i : thinned(truths.size(), kPoints)) {
    way.path.push_back({truths[i]->p_WB_m[0], truths[i]->p_WB_m[1]});
    way.yaw_rad.push_back(yaw_of(truths[i]->q_WB));
  }
  if (!way.path.empty()) add_odometry(way, run, truths);
  return way;
}

/// The way of an anchor that moves.
std::vector<Point> way_of(const record::AnchorTrack& anchor, SimTime until) {
  std::vector<Point> way;
  for (std::size_t i = 0; i <= kPoints; ++i) {
    const auto now = anchor.at(SimTime{} + (until - SimTime{}) * static_cast<int>(i) /
                                               static_cast<int>(kPoints));
    way.push_back({now.p_WA_m[0], now.p_WA_m[1]});
  }
  return way;
}

std::vector<Point> outline_of(const record::Anchor& anchor) {
  const Point centre{anchor.p_WA_m[0], anchor.p_WA_m[1]};
  const double half_x_m = 0.5 * anchor.size_m[0], half_y_m = 0.5 * anchor.size_m[1];
  std::vector<Point> outline;
  if (anchor.shape == "box") {
    for (const auto& [x, y] : {std::pair{1, 1}, {-1, 1}, {-1, -1}, {1, -1}, {1, 1}})
      outline.push_back(placed(centre, yaw_of(anchor.q_WA), x * half_x_m, y * half_y_m));
    return outline;
  }
  for (int i = 0; i <= kCirclePoints; ++i)
    outline.push_back(placed(centre, 2.0 * std::numbers::pi * i / kCirclePoints, half_x_m, 0.0));
  return outline;
}

// Drawing.

DataBlock block_of(const std::string& name, const std::vector<Point>& points) {
  DataBlock block(name);
  for (const Point& p : points) block.add(p.x_m, p.y_m);
  return block;
}

DataBlock ticks_of(const std::string& name, const Way& way, double length_m) {
  DataBlock block(name);
  for (const std::size_t i : thinned(way.path.size(), kTicks)) {
    block.add(way.path[i].x_m, way.path[i].y_m, length_m * std::cos(way.yaw_rad[i]),
              length_m * std::sin(way.yaw_rad[i]));
  }
  return block;
}

// The ticks get longer from run to run, because runs that turn in one place would hide each other.
void add_way(Drawing& drawing, const PlottedRun& run, const Way& way, std::size_t index,
             double tick_m) {
  const Ink ink = series_ink(run.series);
  const double length_m = tick_m * (1.0 + 0.5 * static_cast<double>(index));
  drawing.add(ticks_of(fmt::format("ticks{}", index), way, length_m),
              "with vectors nohead linewidth 0.8", ink, "");
  // Signs on the line, so that its colour is not all that tells it from others.
  constexpr std::array kSigns = {7, 9, 11, 13, 1};  // of gnuplot: disc, triangles, diamond, cross
  drawing.add(
      block_of(fmt::format("path{}", index), way.path),
      fmt::format("with linespoints linewidth 2 pointtype {} pointsize 0.6 pointinterval {}",
                  kSigns[run.series % kSigns.size()], kPoints / 8),
      ink, run.label);
  DataBlock odometry(fmt::format("odometry{}", index));
  for (const std::vector<Point>& of_task : way.odometry) {
    if (!odometry.empty()) odometry.interrupt();
    for (const std::size_t i : thinned(of_task.size(), kPoints))
      odometry.add(of_task[i].x_m, of_task[i].y_m);
  }
  drawing.add(odometry, "with lines linewidth 1.4 dashtype '-'", ink,
              run.label + ", dead reckoning");
}

void add_ends(Drawing& drawing, std::span<const PlottedRun> runs, const std::vector<Way>& ways) {
  DataBlock starts("starts");
  for (const Way& way : ways) {
    if (!way.path.empty()) starts.add(way.path.front().x_m, way.path.front().y_m);
  }
  drawing.add(starts, "with points pointtype 6 pointsize 1.3 linewidth 2", Ink::kForeground,
              "start");
  for (std::size_t i = 0; i < ways.size(); ++i) {
    if (ways[i].path.empty()) continue;
    drawing.add(block_of(fmt::format("end{}", i), {ways[i].path.back()}),
                "with points pointtype 5 pointsize 0.9", series_ink(runs[i].series),
                i + 1 == ways.size() ? "end" : "");
  }
}

/// Anchors that move are drawn where they begin.
std::string anchors_script(Drawing& drawing, const std::vector<record::AnchorTrack>& anchors,
                           SimTime until, double middle_y_m) {
  std::string labels;
  for (std::size_t i = 0; i < anchors.size(); ++i) {
    const record::Anchor start = anchors[i].at(SimTime{});
    const std::vector<Point> outline = outline_of(start);
    drawing.add(block_of(fmt::format("anchor{}", i), outline), "with filledcurves closed",
                Ink::kAnchor, "", "fillstyle solid 0.45 border");
    if (anchors[i].moves())
      drawing.add(block_of(fmt::format("anchor_path{}", i), way_of(anchors[i], until)),
                  "with lines linewidth 1 dashtype '.'", Ink::kAnchor, "");
    Bounds around;
    for (const Point& p : outline) around.add(p);
    const bool below = start.p_WA_m[1] > middle_y_m;
    labels +=
        fmt::format("set label {} at {:.6g},{:.6g} center offset 0,{} textcolor {}\n",
                    quoted(start.name), start.p_WA_m[0], below ? around.bottom_m : around.top_m,
                    below ? -0.9 : 0.8, gnuplot_colour(Ink::kForeground));
  }
  return labels;
}

Bounds bounds_of(const std::vector<Way>& ways, const std::vector<record::AnchorTrack>& anchors) {
  Bounds bounds;
  for (const Way& way : ways) {
    for (const Point& p : way.path) bounds.add(p);
    for (const std::vector<Point>& of_task : way.odometry)
      for (const Point& p : of_task) bounds.add(p);
  }
  for (const record::AnchorTrack& anchor : anchors) {
    for (const Point& p : outline_of(anchor.at(SimTime{}))) bounds.add(p);
  }
  return bounds;
}

// Extends the ranges until a metre has the same length on both axes, with a margin.
std::string scaled(Frame& frame, const Bounds& bounds) {
  constexpr double kLeast_m = 1.0, kRoom = 1.15, kLow_px = 190.0, kHigh_px = 520.0;
  const double inner_width_px = kPlotWidth_px - frame.left_px - frame.right_px;
  double width_m = kRoom * std::max(bounds.width_m(), kLeast_m);
  double height_m = kRoom * std::max(bounds.height_m(), kLeast_m);
  const double inner_height_px = std::clamp(inner_width_px * height_m / width_m, kLow_px, kHigh_px);
  frame.height_px = static_cast<int>(inner_height_px) + frame.top_px + frame.bottom_px;
  const double aspect = static_cast<int>(inner_height_px) / inner_width_px;
  if (height_m > width_m * aspect)
    width_m = height_m / aspect;
  else
    height_m = width_m * aspect;
  const double x_m = 0.5 * (bounds.left_m + bounds.right_m);
  const double y_m = 0.5 * (bounds.bottom_m + bounds.top_m);
  return range_script("x", x_m - 0.5 * width_m, x_m + 0.5 * width_m) +
         range_script("y", y_m - 0.5 * height_m, y_m + 0.5 * height_m);
}

// gnuplot's legend has columns as wide as its longest entry; letters are about 7.5 px wide.
int key_rows(std::span<const PlottedRun> runs, const std::vector<Way>& ways) {
  constexpr double kLetter_px = 7.5, kSample_px = 60.0;
  constexpr std::string_view kAfter = ", dead reckoning";
  std::size_t entries = 2, longest = 5;  // "start" and "end"
  for (std::size_t i = 0; i < ways.size(); ++i) {
    const bool both = !ways[i].odometry.empty();
    entries += both ? 2 : 1;
    longest = std::max(longest, runs[i].label.size() + (both ? kAfter.size() : 0));
  }
  const double column_px = kLetter_px * static_cast<double>(longest) + kSample_px;
  const auto columns = static_cast<std::size_t>(std::max(1.0, kPlotWidth_px / column_px));
  return static_cast<int>((entries + columns - 1) / columns);
}

}  // namespace

std::optional<Plot> path_plot(std::span<const PlottedRun> runs) {
  std::vector<Way> ways;
  for (const PlottedRun& run : runs) ways.push_back(way_of(run));
  if (std::ranges::all_of(ways, [](const Way& way) { return way.path.empty(); }))
    return std::nullopt;
  const record::Record& first = *runs.front().record;
  std::vector<record::AnchorTrack> anchors;
  for (const record::Anchor& anchor : first.header.anchors) anchors.emplace_back(anchor, first);
  const SimTime until =
      first.ground_truth.empty() ? SimTime{} : first.ground_truth.back().message.at;
  Bounds bounds = bounds_of(ways, anchors);
  for (const record::AnchorTrack& anchor : anchors)
    if (anchor.moves())
      for (const Point& p : way_of(anchor, until)) bounds.add(p);
  const int rows = key_rows(runs, ways);
  Frame frame{.top_px = 18 + 21 * rows,
              .key_rows = rows,
              .x_label = "East, x (m)",
              .y_label = "North, y (m)"};
  const std::string ranges = scaled(frame, bounds);
  const double tick_m = 0.05 * std::max({bounds.width_m(), bounds.height_m(), 1.0});
  Drawing drawing;
  const std::string labels =
      anchors_script(drawing, anchors, until, 0.5 * (bounds.bottom_m + bounds.top_m));
  for (std::size_t i = 0; i < ways.size(); ++i) add_way(drawing, runs[i], ways[i], i, tick_m);
  add_ends(drawing, runs, ways);
  std::string title = "Path, seen from above";
  for (const PlottedRun& run : runs) title += ", " + run.label;
  return Plot{frame_script(frame) + ranges + labels + drawing.script(), title};
}

}  // namespace tether::report
