#include "pages/html.h"
#include "pages/page_figures.h"
#include "pages/verdict_html.h"

#include <algorithm>

#include <fmt/format.h>

#include <tether/base/counted.h>
#include <tether/report/uavs_report.h>

namespace tether::report {
namespace {

Table uavs_table(const UavsReport& report) {
  Table table{
      "All numbers of UAVs that were flown",
      {{{"UAVs"}, {"flights"}, {"reached"}, {"interval"}}},
      {},
      {fmt::format("Interval: the exact one (Clopper and Pearson), {:.4g} %, of each number "
                   "alone.",
                   100.0 * report.question.confidence)}};
  for (const auto& [level, share] : levels_of(report))
    table.rows.push_back(
        {std::to_string(level.uavs), std::to_string(level.flights), std::to_string(level.reached),
         fmt::format("{:.0f} to {:.0f} %", 100.0 * share.low, 100.0 * share.high)});
  return table;
}

Table setup_table(const UavsReport& report) {
  Table table{"", {{{""}, {""}}}, {}, {}, 2};
  table.rows = {{"question",
                 fmt::format("the largest number of UAVs with which {:.4g} % of the flights reach "
                             "the goal",
                             100.0 * report.question.success)},
                {"searched", fmt::format("the first {} to {} UAVs of the scenario; at most {}",
                                         report.question.least, report.question.most,
                                         counted(report.most_flights, "flight"))},
                {"board",
                 report.cores == 0 ? report.board  // a real one
                                   : fmt::format("{}, {} core{}", report.board, report.cores,
                                                 report.cores == 1 ? "" : "s")},
                {"method",
                 "bisection, then flights with both neighbours of the answer until their exact "
                 "intervals decide"}};
  for (const auto& [name, value] : report.settings)
    if (!name.starts_with("file ")) table.rows.push_back({name, value});
  return table;
}

}  // namespace

std::string uavs_page(const UavsReport& report) {
  const std::string title = report.scenario + ": how many UAVs does this board carry?";
  FigureMaker figures(1);
  std::string body = element("h1", title);
  body += answer_block(uavs_answers(report), uavs_advice(report));
  body += figures.plot(uavs_plot(report),
                       "Each dot is the share of flights that reach the goal, with its exact "
                       "interval. Dotted: the share that is wanted.");
  body += to_html(uavs_table(report));
  if (const auto& pace = report.pace.pace) {
    const std::size_t uavs = std::max<std::size_t>(1, pace->programs);
    body += to_html(stages_table(
        fmt::format("{}, {} UAV{}", report.condition, uavs, uavs == 1 ? "" : "s"), *pace));
  }
  if (!report.not_flown.empty()) body += problems_box(report.not_flown);
  body += "<section id=\"basis\">\n" + element("h2", "Setup and checks") +
          to_html(setup_table(report), "Setup and checks") + "</section>\n";
  return html_page(title, body);
}

}  // namespace tether::report
