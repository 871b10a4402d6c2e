#include "pages/html.h"
#include "pages/page_figures.h"
#include "pages/verdict_html.h"
#include "plots/svg.h"
#include "tables/report_format.h"

#include <fmt/format.h>

#include <tether/base/counted.h>
#include <tether/report/size_report.h>
#include <tether/report/table.h>

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
  for (const auto& [name, value] : report.settings)
    if (!name.starts_with("file ")) table.rows.push_back({name, value});
  return table;
}

}  // namespace

std::string size_page(const SizeReport& report) {
  FigureMaker figures(1);
  std::string body = element("h1", report.scenario + ": how slow a computer is fast enough?");
  body += answer_block(size_answers(report), size_advice(report));
  body += figures.plot(size_plot(report),
                       "A dot is a flight that reached the goal, a cross one that missed it. The "
                       "line is the share of "
                       "flights that reach the goal, the band its interval. Shaded: the interval "
                       "of the largest sufficient slowdown. Below: how far each "
                       "metric is within its limit, in shares of the limit.");
  if (!report.boards.empty()) body += to_html(boards_table(report));
  if (const auto& pace = report.pace.pace)
    body += to_html(stages_table(report.synchronised.condition + ", near the limit", *pace));
  if (!report.not_flown.empty()) body += problems_box(report.not_flown);
  body += folded("All slowdowns that were flown", to_html(levels_table(report)));
  body += "<section id=\"basis\">\n" + element("h2", "Setup and checks") +
          to_html(basis_of(report), "Setup and checks") + "</section>\n";
  return html_page(report.scenario + ": how slow a computer is fast enough?", body);
}

}  // namespace tether::report
