#include "tables/report_format.h"

#include <fmt/format.h>

#include <tether/base/text.h>
#include <tether/report/verdict.h>

// The tables below an answer: what was compared, and where the computing time goes.
namespace tether::report {
namespace {

constexpr double kLeastShare = 0.001;  // of a stage

std::string headroom_text(const Pace& pace) {
  const std::optional<double> headroom = pace.headroom();
  return headroom ? fmt::format("{:.2g} ×", *headroom) : kNone;
}

Table empty_stages_table() {
  Table table;
  table.title = "Where the computing time goes";
  table.headings = {
      single_headings({"Condition", "Stage", "Times", "Median (ms)", "95 % (ms)", "Share"})};
  table.text_columns = 2;
  table.notes = {
      "“A to B” is what the program computes between its calls A and B. Of a program as it is, "
      "“receive” is each wait: for its sensors, its flight controller or a time."};
  return table;
}

void add_stages(Table& table, const std::string& where, const Pace& pace) {
  for (const timing::StageRow& row : pace.stages)
    if (row.share >= kLeastShare)
      table.rows.push_back({where, row.stage, std::to_string(row.count),
                            fixed(1e3 * row.median_s, 3), fixed(1e3 * row.p95_s, 3),
                            fmt::format("{:.1f} %", 100.0 * row.share)});
  std::string note = fmt::format("{}: seed {}. Stages below 0.1 % are left out.", where, pace.seed);
  if (!pace.camera.empty())
    note += fmt::format(
        " Per image of “{}”: {}{}, in 95 % of them at most {}; read {} times a second{}.",
        pace.camera, short_ms(pace.median_s),
        pace.shares_real_board      ? " of computing and waiting for cores"
        : pace.shared_board.empty() ? " of computing"
                                    : fmt::format(", {} of it waiting for the cores of “{}”",
                                                  share_text(pace.waiting), pace.shared_board),
        short_ms(pace.p95_s), rate_text(pace.read_hz),
        pace.offered_hz ? fmt::format(", offered {} times", rate_text(*pace.offered_hz)) : "");
  table.notes.push_back(note);
}

}  // namespace

Table rulings_table(const std::vector<Verdict>& points) {
  const bool is_sweep = !points.front().point.empty();
  Table table;
  table.title = fmt::format("What was compared in {}", points.front().scenario);
  table.text_columns = is_sweep ? 3 : 2;
  std::vector<std::string> headings = {"Condition",     "Fast enough?",       "Goal reached",
                                       "95 % interval", "Headroom per image", "Closest limit"};
  if (is_sweep) headings.insert(headings.begin(), "With");
  table.headings = {single_headings(headings)};
  for (const Verdict& point : points) {
    for (const ConditionVerdict& one : point.conditions) {
      const bool says_nothing = one.ruling == Ruling::kFreeRunning || one.ruling == Ruling::kUnseen;
      std::vector<std::string> row = {
          one.condition,
          name(one),
          fmt::format("{} of {}", one.reached, one.flown),
          !one.share || says_nothing ? kNone
          : one.flown > 1 && one.is_one_flight()
              ? fmt::format("one flight, {} times", one.flown)
              : fmt::format("{:.0f} to {:.0f} %", 100.0 * one.share->low, 100.0 * one.share->high),
          one.pace ? headroom_text(*one.pace) : kNone,
          one.closest
              ? fmt::format("{}: {}", one.closest->first, distance_text(one.closest->second))
              : kNone};
      if (is_sweep) row.insert(row.begin(), point.point);
      table.rows.push_back(std::move(row));
    }
  }
  table.notes = {
      fmt::format("Fast enough: {} flights or more reach the goal within the limits, by the exact "
                  "interval (Clopper and Pearson) of different flights: copies, whose seeds change "
                  "nothing, count once. “So far”: all did, but they are too few to be sure.",
                  kWanted),
      "Headroom per image: how many times slower the program could compute and still read every "
      "image of the camera, in 95 % of them; below 1, it skips images, which many tasks tolerate. "
      "The "
      "headroom of the whole task: tether size."};
  return table;
}

Table stages_table(const std::vector<Verdict>& points) {
  Table table = empty_stages_table();
  for (const Verdict& point : points) {
    for (const ConditionVerdict& one : point.conditions) {
      const std::string where =
          point.point.empty() ? one.condition : point.point + ", " + one.condition;
      if (one.pace) add_stages(table, where, *one.pace);
    }
  }
  return table;
}

Table stages_table(const std::string& condition, const Pace& pace) {
  Table table = empty_stages_table();
  add_stages(table, condition, pace);
  return table;
}

}  // namespace tether::report
