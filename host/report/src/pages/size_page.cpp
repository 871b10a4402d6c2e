#include "pages/html.h"
#include "pages/page_figures.h"
#include "pages/verdict_html.h"
#include "plots/svg.h"
#include "tables/report_format.h"

#include <algorithm>

#include <fmt/format.h>

#include <tether/base/text.h>
#include <tether/report/size_report.h>

namespace tether::report {
namespace {

std::string times_text(double value) {
  return fmt::format("{:.3g}", value);
}

std::string verdict_text(BoardVerdict verdict) {
  switch (verdict) {
    case BoardVerdict::kSuffices:
      return "sufficient";
    case BoardVerdict::kDoesNot:
      return "not sufficient";
    case BoardVerdict::kUndecided:
      break;
  }
  return "undecided";
}

Table boards_table(const SizeReport& report) {
  Table table{
      "Boards", {{{"board"}, {"slower"}, {"calibration"}, {"headroom"}, {"verdict"}}}, {}, {}};
  const sizing::Answer& answer = report.synchronised.answer;
  for (const Board& board : report.boards) {
    table.rows.push_back(
        {board.name, times_text(board.slowdown),
         board.low ? fmt::format("{} to {}", times_text(*board.low), times_text(*board.high)) : "–",
         fmt::format("{:.2g}", answer.threshold.estimate / board.slowdown),
         verdict_text(verdict(board, report))});
  }
  return table;
}

Table levels_table(const SizeReport& report) {
  const double confidence = report.question.confidence;
  Table table{"All slowdowns that were flown",
              {{{"slower"}, {"flights"}, {"reached"}, {"share"}, {"interval"}}},
              {},
              {fmt::format("Interval: exact (Clopper and Pearson), {:.4g} %, of each row alone.",
                           100.0 * confidence)}};
  for (const sizing::Level& level :
       sizing::levels_of(report.question, report.synchronised.flights, confidence)) {
    if (level.flights == 0) continue;
    table.rows.push_back(
        {times_text(level.slowdowns.front()) + " to " + times_text(level.slowdowns.back()),
         std::to_string(level.flights), std::to_string(level.reached),
         share_text(level.share.estimate),
         share_text(level.share.low) + " to " + share_text(level.share.high)});
  }
  return table;
}

void add_settings(Table& table, const campaign::Settings& settings) {
  for (const auto& [name, value] : settings)
    if (!name.starts_with("file ")) table.rows.push_back({name, value});
}

Table basis_of(const SizeReport& report) {
  const sizing::Question& question = report.question;
  const sizing::Answer& answer = report.synchronised.answer;
  Table table{"", {{{""}, {""}}}, {}, {}, 2};
  table.rows = {
      {"question", fmt::format("the largest slowdown at which {} of the flights reach the goal",
                               share_text(question.success))},
      {"searched",
       fmt::format("{} to {} × slower than “{}”; at most {}", times_text(question.least),
                   times_text(question.most), report.synchronised.condition,
                   counted(report.most_flights, "flight"))},
      {"method",
       answer.basis == sizing::Basis::kLevels
           ? "each neighbourhood of slowdowns alone, because no curve fits"
           : fmt::format("logistic curve over the logarithm of the slowdown with lapse "
                         "rate and floor, Bayesian, from {}",
                         answer.basis == sizing::Basis::kMargins ? "the margins of the metrics"
                                                                 : "reached and missed goals")}};
  add_settings(table, report.settings);
  return table;
}

Table uavs_table(const UavsReport& report) {
  Table table{
      "All numbers of UAVs that were flown",
      {{{"UAVs"}, {"flights"}, {"reached"}, {"interval"}}},
      {},
      {fmt::format("Interval: the exact one (Clopper and Pearson), {:.4g} %, of each number "
                   "alone.",
                   100.0 * report.question.confidence)}};
  for (const sizing::UavLevel& level : uav_levels(report.points)) {
    const sizing::Share share = level.share(report.question.confidence);
    table.rows.push_back(
        {std::to_string(level.uavs), std::to_string(level.flights), std::to_string(level.reached),
         fmt::format("{:.0f} to {:.0f} %", 100.0 * share.low, 100.0 * share.high)});
  }
  return table;
}

Table basis_of(const UavsReport& report) {
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
  add_settings(table, report.settings);
  return table;
}

}  // namespace

SizeAnswer size_answer(const SizeReport& report) {
  SizeAnswer answer{.scenario = report.scenario,
                    .condition = report.synchronised.condition,
                    .question = "how slow a computer is fast enough?",
                    .answers = size_answers(report),
                    .advice = size_advice(report),
                    .is_answered = is_answered(report),
                    .plot = size_plot(report),
                    .caption =
                        "A dot is a flight that reached the goal, a cross one that missed "
                        "it. The line is the share of flights that reach the goal, the band "
                        "its interval. Shaded: the interval of the largest sufficient "
                        "slowdown. Below: how far each metric is within its limit, in "
                        "shares of the limit.",
                    .levels = levels_table(report),
                    .basis = basis_of(report),
                    .not_flown = report.not_flown,
                    .json = size_json(report)};
  for (const Board& board : report.boards)
    answer.boards.push_back({board.name, verdict(board, report) == BoardVerdict::kSuffices,
                             board_answer(board, report)});
  for (const campaign::TrialResult& trial : report.synchronised.trials)
    answer.trials.push_back(&trial);
  if (!report.boards.empty()) answer.tables.push_back(boards_table(report));
  if (const auto& pace = report.pace.pace)
    answer.tables.push_back(stages_table(answer.condition + ", near the limit", *pace));
  return answer;
}

SizeAnswer size_answer(const UavsReport& report) {
  SizeAnswer answer{.scenario = report.scenario,
                    .condition = report.condition,
                    .question = "how many UAVs does this board carry?",
                    .answers = uavs_answers(report),
                    .advice = uavs_advice(report),
                    .is_answered = is_answered(report),
                    .plot = uavs_plot(report),
                    .caption =
                        "Each dot is the share of flights that reach the goal, with its "
                        "exact interval. Dotted: the share that is wanted.",
                    .tables = {uavs_table(report)},
                    .basis = basis_of(report),
                    .not_flown = report.not_flown,
                    .json = size_json(report)};
  for (const UavsPoint& point : report.points)
    for (const campaign::TrialResult& trial : point.trials) answer.trials.push_back(&trial);
  if (const auto& pace = report.pace.pace) {
    const std::size_t uavs = std::max<std::size_t>(1, pace->programs);
    answer.tables.push_back(stages_table(report.condition + ", " + counted(uavs, "UAV"), *pace));
  }
  return answer;
}

std::string size_page(const SizeAnswer& answer) {
  const std::string title = answer.scenario + ": " + answer.question;
  FigureMaker figures(1);
  std::string body = element("h1", title) + answer_block(answer.answers, answer.advice) +
                     figures.plot(answer.plot, answer.caption);
  for (const Table& table : answer.tables) body += to_html(table);
  if (!answer.not_flown.empty()) body += problems_box(answer.not_flown);
  if (answer.levels) body += folded(answer.levels->title, to_html(*answer.levels));
  body += "<section id=\"basis\">\n" + element("h2", "Setup and checks") +
          to_html(answer.basis, "Setup and checks") + "</section>\n";
  return html_page(title, body);
}

}  // namespace tether::report
