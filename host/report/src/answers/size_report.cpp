#include "answers/sufficient.h"
#include "tables/report_format.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include <tether/base/counted.h>
#include <tether/campaign/campaign_plan.h>
#include <tether/campaign/copies.h>
#include <tether/campaign/statistics.h>
#include <tether/report/size_report.h>

namespace tether::report {
namespace {

// As fast as this and faster, a computer does not help a task whose goal is missed as often as on a
// slower one.
constexpr double kFastEnoughToTell = 0.1;

/// Fewer flights than wanted reach the goal at any slowdown, and the faster ones no more often.
bool is_probably_not_for_speed(const SizeReport& report) {
  return report.synchronised.answer.is_below && !speed_matters(report.synchronised) &&
         report.question.least <= kFastEnoughToTell;
}

// Two digits, as many as an answer deserves: "3.1", "12", "0.85".
std::string digits(double value) {
  const std::string text = fmt::format("{:.2g}", value);
  return text.find('e') == std::string::npos ? text : fmt::format("{:.0f}", value);
}

// Bounds outside of the range that was flown are not known.
std::string interval_text(const sizing::Threshold& threshold, const sizing::Question& question) {
  const std::string low =
      threshold.low > 0.0 ? digits(threshold.low) : "below " + digits(question.least);
  const std::string high =
      std::isfinite(threshold.high) ? digits(threshold.high) : "above " + digits(question.most);
  return "[" + low + ", " + high + "]";
}

std::string percent(double share) {
  return fmt::format("{:.4g} %", 100.0 * share);
}

// "3.1 × slower" or, of a faster computer, "0.5 × the computing time"; then "than" or "of" what.
std::string slower(double slowdown) {
  return digits(slowdown) + (slowdown < 1.0 ? " × the computing time" : " × slower");
}
std::string than(double slowdown) {
  return slowdown < 1.0 ? "of" : "than";
}

/// What the first words must say of the flights on which they rest.
std::string reservation(const SizedCondition& sized) {
  const bool leaves_out = std::ranges::any_of(sized.trials, [](const auto& trial) {
    return std::ranges::any_of(trial.warnings, is_left_out);
  });
  return leaves_out ? std::string(kNotAsWritten) + ";" : ",";
}

Answer main_answer(const SizeReport& report) {
  const SizedCondition& sized = report.synchronised;
  const sizing::Threshold& threshold = sized.answer.threshold;
  const std::string evidence = fmt::format("{}; {}.", percent(report.question.confidence),
                                           counted(sized.flights.size(), "flight"));
  if (sized.answer.is_below) {
    const bool is_for_speed = speed_matters(sized);
    const bool is_known = is_for_speed || is_probably_not_for_speed(report);
    return {is_for_speed ? "Not sufficient"
            : is_known   ? "Goal missed; speed is probably not the reason"
                         : "Goal missed",
            fmt::format(": already at {} × the time of “{}”, fewer than {} of the flights reach "
                        "the goal, {}{}",
                        digits(report.question.least), sized.condition,
                        percent(report.question.success), evidence,
                        is_for_speed ? ""
                        : is_known   ? " The faster ones do not reach it more often."
                                     : " Whether speed is the reason is not known: the faster ones "
                                       "do not reach it more often.")};
  }
  if (sized.answer.is_above)
    return {"Sufficient up to " + slower(report.question.most),
            fmt::format(" {} “{}”, the most that was flown{} {}", than(report.question.most),
                        sized.condition, reservation(sized), evidence)};
  return {"Sufficient up to " + slower(threshold.estimate),
          fmt::format(" {} “{}” {}{} {}", than(threshold.estimate), sized.condition,
                      interval_text(threshold, report.question), reservation(sized), evidence)};
}

Answer board_answer(const Board& board, const SizedCondition& sized) {
  const sizing::Answer& answer = sized.answer;
  const double headroom = answer.threshold.estimate / board.slowdown;
  const std::string name = fmt::format("{} ({} ×)", board.name, digits(board.slowdown));
  switch (verdict(board, sized)) {
    case BoardVerdict::kSuffices:
      return {"Fast enough", fmt::format(": {} has {}{} × headroom.", name,
                                         answer.is_above ? "at least " : "", digits(headroom))};
    case BoardVerdict::kDoesNot:
      return {"Not fast enough",
              fmt::format(": {} is {}{} × too slow.", name, answer.is_below ? "more than " : "",
                          digits(1.0 / headroom))};
    case BoardVerdict::kUndecided:
      break;
  }
  return {"Undecided", fmt::format(": {} may not be fast enough, because {}.", name,
                                   answer.is_above   ? "no flight was as slow as that"
                                   : answer.is_below ? "the flights do not show that speed matters"
                                                     : "it is too close to the limit")};
}

Answer flattery(const SizeReport& report) {
  const SizedCondition& other = *report.unsynchronised;
  const double ratio =
      other.answer.threshold.estimate / report.synchronised.answer.threshold.estimate;
  return {
      "Without synchronisation",
      fmt::format(" (“{}”), {}{} would seem sufficient: {} × {}.", other.condition,
                  other.answer.is_above ? "at least " : "", slower(other.answer.threshold.estimate),
                  digits(ratio), ratio >= 1.0 ? "too much" : "of what really is")};
}

}  // namespace

std::vector<CurvePoint> curve_points(const sizing::SuccessCurve& curve, double least, double most) {
  constexpr int kSteps = 60;
  std::vector<CurvePoint> points;
  for (int i = 0; i <= kSteps; ++i) {
    const double slowdown = least * std::pow(most / least, static_cast<double>(i) / kSteps);
    points.push_back({slowdown, curve.share(slowdown)});
  }
  return points;
}

BoardVerdict verdict(const Board& board, const SizedCondition& sized) {
  const sizing::Answer& answer = sized.answer;
  if (std::ranges::any_of(sized.trials, &campaign::TrialResult::has_unseen_time) ||
      (answer.is_below && !speed_matters(sized)))
    return BoardVerdict::kUndecided;
  const double low = board.low.value_or(board.slowdown), high = board.high.value_or(board.slowdown);
  if (high <= answer.threshold.low && !answer.is_below) return BoardVerdict::kSuffices;
  if (low >= answer.threshold.high && !answer.is_above) return BoardVerdict::kDoesNot;
  return BoardVerdict::kUndecided;
}

bool has_unseen_time(const SizeReport& report) {
  return std::ranges::any_of(report.synchronised.trials, &campaign::TrialResult::has_unseen_time);
}

std::vector<Answer> size_answers(const SizeReport& report) {
  const sizing::Answer& answer = report.synchronised.answer;
  std::vector<const campaign::TrialResult*> trials;
  for (const campaign::TrialResult& trial : report.synchronised.trials) trials.push_back(&trial);
  if (auto unseen = unseen_answer(report.synchronised.condition, trials))
    return {*std::move(unseen)};
  std::vector<Answer> answers = {main_answer(report)};
  for (const Board& board : report.boards)
    answers.push_back(board_answer(board, report.synchronised));
  if (report.unsynchronised) answers.push_back(flattery(report));
  if (answer.basis == sizing::Basis::kLevels)
    answers.push_back(
        {"No smooth curve",
         " fits the flights: near slowdowns differ more in success than such a curve allows. The "
         "answer is by neighbourhoods of slowdowns: the interval is from the largest one that is "
         "sufficient to the smallest one that is not."});
  const std::size_t copies = report.synchronised.copies;
  if (!answer.is_narrow)
    answers.push_back(
        {"Less sure than asked",
         fmt::format(": the interval is wider than a factor of {}, because {}.",
                     digits(report.question.interval),
                     copies >= kMostCopies ? "the seeds change too little"
                     : report.synchronised.flights.size() + copies + report.not_flown.size() >=
                             report.most_flights
                         ? fmt::format("no more than {} were allowed",
                                       counted(report.most_flights, "flight"))
                         : "slowdowns in between could not be decided")});
  std::ranges::move(answers_on_flights(trials, report.pace.unknown), std::back_inserter(answers));
  if (copies > 0)
    answers.push_back({"Not counted", fmt::format(": {} more, each a copy of one at the same "
                                                  "slowdown, because its seed changes nothing.",
                                                  counted(copies, "flight"))});
  return answers;
}

std::vector<std::string> size_sentences(const SizeReport& report) {
  std::vector<std::string> sentences;
  for (const Answer& answer : size_answers(report)) sentences.push_back(answer.lead + answer.rest);
  return sentences;
}

std::vector<std::string> size_advice(const SizeReport& report) {
  const sizing::Answer& answer = report.synchronised.answer;
  std::vector<std::string> advice;
  if (has_unseen_time(report))
    return {
        "Find out what the program waits for, or which threads it has: fly one flight with "
        "`tether run`, which says what to do."};
  if (!answer.is_narrow) advice.emplace_back("Fly more: `--max-trials`, with `--resume`.");
  const bool is_short =
      answer.is_below || std::ranges::any_of(report.boards, [&](const Board& board) {
        return verdict(board, report.synchronised) == BoardVerdict::kDoesNot;
      });
  // Where the flights do not show that speed matters, no stage is to blame.
  const bool has_limit =
      !answer.is_above && (!answer.is_below || speed_matters(report.synchronised));
  if (has_limit && report.pace.pace && !report.pace.pace->stages.empty()) {
    const timing::StageRow& stage = report.pace.pace->stages.front();
    advice.push_back(fmt::format("{}“{}” first: it takes {:.0f} % of the computing time.",
                                 is_short ? "Speed up " : "For more headroom, speed up ",
                                 stage.stage, 100.0 * stage.share));
  }
  if (is_probably_not_for_speed(report))
    advice.emplace_back("Look for the reason in the program, the scenario and its limits.");
  else if (answer.is_below)
    advice.push_back(fmt::format("Search below {} ×: `--between {:.2g},{:.2g}`.",
                                 digits(report.question.least), 0.1 * report.question.least,
                                 report.question.least));
  if (answer.is_above)
    advice.push_back(fmt::format(
        "To find the limit, search beyond {} ×: `--between {:.3g},{:.3g}`.",
        digits(report.question.most), report.question.most, 10.0 * report.question.most));
  if (report.boards.empty())
    advice.emplace_back("To see the headroom of a board, name it: `--target FILE`.");
  if (!report.unsynchronised)
    advice.emplace_back(
        "To see how much a test without synchronisation flatters: `--unsynchronised CONDITION`.");
  return advice;
}

PaceOrReason pace_near_answer(const SizeReport& report) {
  const campaign::TrialResult* nearest = nullptr;
  double least = 0.0;
  const SizedCondition& sized = report.synchronised;
  for (std::size_t i = 0; i < sized.flights.size(); ++i) {
    const double distance =
        std::abs(std::log(sized.flights[i].slowdown / sized.answer.threshold.estimate));
    if (nearest != nullptr && distance >= least) continue;
    nearest = &sized.trials[i];
    least = distance;
  }
  return nearest ? pace_or_reason(*nearest) : PaceOrReason{};
}

std::optional<double> margin_of(const campaign::MetricValue& metric) {
  const bool is_count = metric.unit == "1";
  if (!metric.value || is_count || !(metric.max || metric.min)) return std::nullopt;
  const double limit = metric.max ? *metric.max : *metric.min;
  const double within = metric.max ? limit - *metric.value : *metric.value - limit;
  if (limit == 0.0) return std::nullopt;
  return within / std::abs(limit);
}

std::optional<double> margin_of(const judge::ClauseVerdict& clause) {
  if (!clause.margin || !clause.limit || *clause.limit == 0.0) return std::nullopt;
  return *clause.margin / std::abs(*clause.limit);
}

bool add_flight(SizedCondition& to, const campaign::TrialResult& trial, double slowdown) {
  for (std::size_t i = 0; i < to.flights.size(); ++i) {
    if (to.flights[i].slowdown != slowdown || !campaign::are_copies(to.trials[i], trial)) continue;
    ++to.copies;
    return true;
  }
  to.flights.push_back(flight_of(trial, slowdown));
  to.trials.push_back(trial);
  return false;
}

bool speed_matters(const SizedCondition& sized) {
  std::vector<sizing::Flight> flights = sized.flights;
  std::ranges::stable_sort(flights, {}, &sizing::Flight::slowdown);
  campaign::Count fast, slow;
  for (std::size_t i = 0; i < flights.size(); ++i) {
    campaign::Count& half = 2 * i < flights.size() ? fast : slow;
    ++half.all;
    half.of_them += flights[i].reached ? 1U : 0U;
  }
  return fast.of_them * slow.all > slow.of_them * fast.all &&
         campaign::fisher_exact(fast, slow) < kSignificant;
}

sizing::Flight flight_of(const campaign::TrialResult& trial, double slowdown) {
  sizing::Flight flight{slowdown, trial.outcome == campaign::Outcome::kGoalReached, std::nullopt};
  for (const campaign::MetricValue& metric : trial.metrics) {
    const std::optional<double> margin = margin_of(metric);
    if (margin) flight.margin = std::min(*margin, flight.margin.value_or(*margin));
  }
  if (flight.margin && (*flight.margin >= 0.0) != flight.reached) flight.margin.reset();
  return flight;
}

}  // namespace tether::report
