#include "pages/html.h"
#include "pages/verdict_html.h"
#include "plots/shapes.h"
#include "plots/svg.h"
#include "tables/report_format.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include <tether/base/text.h>
#include <tether/os/child_process.h>
#include <tether/report/report.h>
#include <tether/report/table.h>

namespace tether::report {
namespace {

constexpr std::size_t kBins = 48;
constexpr double kBin_px = 15.0, kBars_px = 150.0, kBars_across_px = kBin_px * kBins;

/// How often the stage took how long, from 0 to its worst time.
std::string histogram(const timing::StageRow& row, const std::vector<double>& times_ns) {
  std::array<std::size_t, kBins> counts{};
  const double worst_ns = std::max(row.worst_s * 1e9, 1.0);
  for (const double time_ns : times_ns) {
    const auto bin = static_cast<std::size_t>(time_ns / worst_ns * static_cast<double>(kBins));
    ++counts[std::min(bin, kBins - 1)];
  }
  const double highest = static_cast<double>(*std::ranges::max_element(counts));
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" role=\"img\" "
      "font-size=\"12\" aria-label=\"{}\">",
      kBars_across_px, kBars_px + 20.0, escape_markup("Histogram of " + row.stage));
  for (std::size_t i = 0; i < kBins; ++i) {
    if (counts[i] == 0) continue;
    const double height_px = std::max(1.0, kBars_px * static_cast<double>(counts[i]) / highest);
    svg += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" {}/>",
                       kBin_px * static_cast<double>(i), kBars_px - height_px, kBin_px - 1.0,
                       height_px, fill_of(series_ink(0)));
  }
  svg += fmt::format(
      "<text x=\"0\" y=\"{0}\" {1}>0</text>"
      "<text x=\"{2}\" y=\"{0}\" text-anchor=\"end\" {1}>{3} ms</text></svg>",
      kBars_px + 15.0, fill_of(Ink::kForeground), kBars_across_px, timing::in_ms(row.worst_s));
  return svg;
}

}  // namespace

Answer timing_answer(const std::vector<timing::StageRow>& rows) {
  if (rows.empty()) return {"Nothing to decide", ": the runs have no calls."};
  const timing::StageRow& most = rows.front();
  return {fmt::format("“{}” takes {:.0f} % of the computing time", most.stage, 100.0 * most.share),
          fmt::format(": {} at a time, and {} in 95 % of the {} times at most.",
                      short_ms(most.median_s), short_ms(most.p95_s), most.count)};
}

std::vector<std::string> timing_advice(const timing::Timing& timing,
                                       const std::vector<timing::StageRow>& rows) {
  std::vector<std::string> advice;
  if (rows.empty()) return advice;
  const timing::StageRow& most = rows.front();
  const bool is_between = timing::is_between_calls(timing, most.stage);
  advice.push_back(fmt::format("{}: at half its time, all computing takes {:.0f} % less.",
                               is_between
                                   ? fmt::format("Mark stages in what the program computes between "
                                                 "its calls (“{}”), and speed up the largest first",
                                                 most.stage)
                                   : fmt::format("Speed up the stage “{}” first", most.stage),
                               50.0 * most.share));
  if (most.count < timing::kFewSamples)
    advice.push_back(
        fmt::format("Record more runs: “{}” has only {} of the {} samples that its "
                    "times need.",
                    most.stage, most.count, timing::kFewSamples));
  const std::string how =
      timing.clock == "wall"
          ? std::string(
                "`tether size`, with a condition that replays these times (`clock = "
                "\"replayed\"`).")
          : fmt::format(
                "`tether size SCENARIO{}`, where SCENARIO is the file or the name of the "
                "scenario “{}”.",
                timing.condition.empty() || timing.condition == timing.board
                    ? ""
                    : " --condition " + os::shell_word(timing.condition),
                timing.scenario);
  advice.push_back(
      "Times alone do not show whether the computer is fast enough. To find its headroom: " + how);
  return advice;
}

std::string timing_page(const timing::Timing& timing) {
  const auto rows = timing::stage_rows(timing);
  const auto samples = timing::samples_of(timing);
  Table table{
      "Computing time of each stage, between two calls",
      {{{"stage"}, {"count"}, {"median ms"}, {"95 % ms"}, {"99 % ms"}, {"worst ms"}, {"share"}}},
      {},
      timing::warnings(rows)};
  std::string figures;
  for (const timing::StageRow& row : rows) {
    table.rows.push_back({row.stage, std::to_string(row.count), timing::in_ms(row.median_s),
                          timing::in_ms(row.p95_s), timing::in_ms(row.p99_s),
                          timing::in_ms(row.worst_s), fixed(100.0 * row.share, 1) + " %"});
    figures += figure(histogram(row, samples.at(row.stage)),
                      fmt::format("{}: {} times, median {} ms, worst {} ms", row.stage, row.count,
                                  timing::in_ms(row.median_s), timing::in_ms(row.worst_s)),
                      "plot");
  }
  const std::string title = timing.scenario + ": computing time by stage";
  const std::string source =
      fmt::format("{}, build {}, clock {}, on {}; {}, recorded {}", timing.program,
                  timing.build_id.empty() ? "unknown" : timing.build_id, timing.clock, timing.board,
                  timing::runs_text(timing), timing.recorded_at);
  return html_page(title, element("h1", title) +
                              answer_block({timing_answer(rows)}, timing_advice(timing, rows)) +
                              figures + to_html(table) + element("p", source));
}

std::string timing_csv(const std::vector<timing::StageRow>& rows) {
  Table table;
  table.headings = {
      {{"stage"}, {"count"}, {"median_s"}, {"p95_s"}, {"p99_s"}, {"worst_s"}, {"share"}}};
  const auto text = [](double value) { return fmt::format("{}", value); };
  for (const timing::StageRow& row : rows)
    table.rows.push_back({row.stage, std::to_string(row.count), text(row.median_s), text(row.p95_s),
                          text(row.p99_s), text(row.worst_s), text(row.share)});
  return to_csv(table);
}

}  // namespace tether::report
