#include "answers/success_gap.h"
#include "answers/sufficient.h"
#include "tables/report_format.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include <tether/base/text.h>
#include <tether/campaign/campaign_plan.h>
#include <tether/campaign/campaign_results.h>
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

/// What the first words must say of the flights on which they rest, and a separator.
std::string reservation(const SizedCondition& sized) {
  const std::string text = reservation_on(pointers_to(sized.trials));
  return text.empty() ? "," : text + ";";
}

/// Whether the answer is above slowdowns that fail.
bool is_above_gap(const SizeReport& report) {
  const std::optional<SuccessGap> gap = success_gap(report);
  const sizing::Answer& answer = report.synchronised.answer;
  return gap && !answer.is_below &&
         (answer.is_above || answer.threshold.estimate > gap->fails.from);
}

double low_of(const Board& board) {
  return board.low.value_or(board.slowdown);
}
double high_of(const Board& board) {
  return board.high.value_or(board.slowdown);
}

/// Whether the board is as slow as slowdowns that fail while slower ones succeed, or slower.
bool reaches(const Board& board, const std::optional<SuccessGap>& gap) {
  return gap && high_of(board) >= gap->fails.from;
}

/// On what the answer rests: "95 %; 92 flights.".
std::string evidence_of(const SizeReport& report) {
  const std::size_t flights = report.synchronised.flights.size();
  if (is_one_start(report.synchronised))
    return fmt::format(
        "at {}. The seeds change nothing, so this is one flight at several speeds, "
        "and what others do is not known.",
        counted(flights, "slowdown"));
  return fmt::format("{}; {}.", percent(report.question.confidence), counted(flights, "flight"));
}

std::string band_text(const Band& band) {
  return fmt::format("{} of {} at {:.3g}{} ×", band.flights.of_them,
                     counted(band.flights.all, "flight"), band.from,
                     band.from < band.to ? fmt::format(" to {:.3g}", band.to) : "");
}

Answer gap_answer(const SuccessGap& gap, const SizeReport& report) {
  return {"Slower computers reach the goal again",
          fmt::format(": {} reach it, but {}. {}", band_text(gap.fails), band_text(gap.again),
                      is_above_gap(report) ? "The limit that follows is too high: slowdowns below "
                                             "it fail."
                                           : "The limit that follows is below those that fail.")};
}

/// Whether the least slowdown, too, may be insufficient.
bool shows_no_sufficient(const SizedCondition& sized) {
  return !is_one_start(sized) && !sized.answer.is_below && sized.answer.threshold.low <= 0.0;
}

/// What the interval of flights does not contain: " (without the machine's spread of 60 %)"; empty:
/// the machine was quiet.
std::string spread_text(const SizedCondition& sized) {
  double spread = 0.0;
  for (const campaign::TrialResult& trial : sized.trials)
    for (const campaign::Doubt& doubt : trial.this_run.doubts)
      if (doubt.kind == campaign::Doubt::Kind::kBusyMachine)
        spread = std::max(spread, doubt.amount);
  return spread > 0.0 ? fmt::format(" (without the machine's spread of {:.0f} %)", 100.0 * spread)
                      : "";
}

Answer main_answer(const SizeReport& report) {
  const SizedCondition& sized = report.synchronised;
  const sizing::Threshold& threshold = sized.answer.threshold;
  const bool is_one = is_one_start(sized);
  const std::string evidence = evidence_of(report);
  const std::string in_one = is_one ? "In one flight, sufficient up to " : "Sufficient up to ";
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
    return {in_one + slower(report.question.most),
            fmt::format(" {} “{}”, the most that was flown{} {}", than(report.question.most),
                        sized.condition, reservation(sized), evidence)};
  const std::string interval =
      is_one ? "" : " " + interval_text(threshold, report.question) + spread_text(sized);
  if (shows_no_sufficient(sized))
    return {
        "Undecided",
        fmt::format(": no slowdown of “{}” is shown to be sufficient. The limit is within{}, {}",
                    sized.condition, interval, evidence)};
  return {in_one + slower(threshold.estimate),
          fmt::format(" {} “{}”{}{} {}", than(threshold.estimate), sized.condition, interval,
                      reservation(sized), evidence)};
}

/// Why it is not known whether the board is fast enough.
std::string why_undecided(const Board& board, const SizeReport& report) {
  const sizing::Answer& answer = report.synchronised.answer;
  if (has_unseen_time(report))
    return "programs waited or computed in ways that Tether does not see";
  if (is_one_start(report.synchronised)) return "the seeds change nothing: this is one flight";
  if (reaches(board, success_gap(report)))
    return "success does not fall steadily with the slowdown";
  if (answer.is_above) return "no flight was as slow as that";
  return answer.is_below ? "the flights do not show that speed matters"
                         : "it is too close to the limit";
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

std::vector<CurvePoint> curve_points(const sizing::SuccessCurve& curve,
                                     const sizing::Question& question) {
  constexpr int kSteps = 60;
  std::vector<CurvePoint> points;
  for (int i = 0; i <= kSteps; ++i) {
    const double part = static_cast<double>(i) / kSteps;
    const double slowdown = question.least * std::pow(question.most / question.least, part);
    points.push_back({slowdown, curve.share(slowdown)});
  }
  return points;
}

BoardVerdict verdict(const Board& board, const SizeReport& report) {
  const SizedCondition& sized = report.synchronised;
  const sizing::Answer& answer = sized.answer;
  if (has_unseen_time(report) || is_one_start(sized) || (answer.is_below && !speed_matters(sized)))
    return BoardVerdict::kUndecided;
  const std::optional<SuccessGap> gap = success_gap(report);
  const bool reaches_gap = reaches(board, gap);
  if (high_of(board) <= answer.threshold.low && !answer.is_below && !reaches_gap)
    return BoardVerdict::kSuffices;
  const bool may_succeed = reaches_gap && high_of(board) > gap->fails.to;
  if (low_of(board) >= answer.threshold.high && !answer.is_above && !may_succeed)
    return BoardVerdict::kDoesNot;
  return BoardVerdict::kUndecided;
}

Answer board_answer(const Board& board, const SizeReport& report) {
  const sizing::Answer& answer = report.synchronised.answer;
  const double headroom = answer.threshold.estimate / board.slowdown;
  const std::string name = fmt::format("{} ({} ×)", board.name, digits(board.slowdown));
  switch (verdict(board, report)) {
    case BoardVerdict::kSuffices:
      return {"Fast enough" + reservation_on(pointers_to(report.synchronised.trials)),
              fmt::format(": {} has {}{} × headroom.", name, answer.is_above ? "at least " : "",
                          digits(headroom))};
    case BoardVerdict::kDoesNot:
      return {"Not fast enough",
              fmt::format(": {} is {}{} × too slow.", name, answer.is_below ? "more than " : "",
                          digits(1.0 / headroom))};
    case BoardVerdict::kUndecided:
      break;
  }
  return {"Undecided", fmt::format(": {} may not be fast enough, because {}.", name,
                                   why_undecided(board, report))};
}

bool has_unseen_time(const SizeReport& report) {
  return std::ranges::any_of(report.synchronised.trials, &campaign::TrialResult::has_unseen_time);
}

bool is_answered(const SizeReport& report) {
  const SizedCondition& sized = report.synchronised;
  return sized.answer.is_narrow && !sized.answer.is_below && !is_one_start(sized) &&
         !shows_no_sufficient(sized) && !is_above_gap(report) && !has_unseen_time(report);
}

std::vector<Answer> size_answers(const SizeReport& report) {
  const sizing::Answer& answer = report.synchronised.answer;
  const std::vector<const campaign::TrialResult*> trials = pointers_to(report.synchronised.trials);
  if (auto unseen = unseen_answer(report.synchronised.condition, trials))
    return {*std::move(unseen)};
  std::vector<Answer> answers;
  if (const auto gap = success_gap(report)) answers.push_back(gap_answer(*gap, report));
  answers.push_back(main_answer(report));
  if (report.is_interrupted) answers.back().lead.insert(0, kSoFar);
  for (const Board& board : report.boards) answers.push_back(board_answer(board, report));
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
         fmt::format(": the interval is wider than a factor of {:.3g}, because {}.",
                     report.question.interval,
                     report.is_interrupted           ? "the search was interrupted"
                     : copies >= sizing::kMostCopies ? "the seeds change too little"
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

std::vector<std::string> size_advice(const SizeReport& report) {
  const sizing::Answer& answer = report.synchronised.answer;
  std::vector<std::string> advice;
  if (has_unseen_time(report))
    return {
        "Find out what the program waits for, or which threads it has: fly one flight with "
        "`tether run`, which says what to do."};
  const bool is_exhausted = !answer.is_narrow && report.synchronised.copies >= sizing::kMostCopies;
  if (is_exhausted || is_one_start(report.synchronised))
    advice.emplace_back(kVarySeeds);
  else if (!answer.is_narrow && !report.is_interrupted)
    advice.emplace_back("Fly more: `--max-trials`, with `--resume`.");
  if (success_gap(report))
    advice.emplace_back(
        "Look at the figure, and fly slowdowns that fail again with `tether run --slowdown`.");
  const bool is_short =
      answer.is_below || std::ranges::any_of(report.boards, [&](const Board& board) {
        return verdict(board, report) == BoardVerdict::kDoesNot;
      });
  // Where the flights do not show that speed matters, no stage is to blame.
  const bool has_limit = !answer.is_above && !shows_no_sufficient(report.synchronised) &&
                         (!answer.is_below || speed_matters(report.synchronised));
  if (has_limit && report.pace.pace && !report.pace.pace->stages.empty()) {
    const timing::StageRow& stage = report.pace.pace->stages.front();
    advice.push_back(fmt::format("{}“{}” first: it takes {:.0f} % of the computing time.",
                                 is_short ? "Speed up " : "For more headroom, speed up ",
                                 stage.stage, 100.0 * stage.share));
  }
  if (is_probably_not_for_speed(report))
    advice.emplace_back("Look for the reason in the program, the scenario and its limits.");
  else if (answer.is_below)
    advice.push_back(fmt::format(
        "Search below {} ×: `--between {:.2g},{:.2g}`, with another `--out`.",
        digits(report.question.least), 0.1 * report.question.least, report.question.least));
  if (answer.is_above)
    advice.push_back(fmt::format(
        "To find the limit, search beyond {} ×: `--between {:.3g},{:.3g}`, with another `--out`.",
        digits(report.question.most), report.question.most, 10.0 * report.question.most));
  if (is_probably_not_for_speed(report)) return advice;
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

bool is_one_start(const SizedCondition& sized) {
  std::vector<double> slowdowns;
  for (const sizing::Flight& flight : sized.flights) slowdowns.push_back(flight.slowdown);
  std::ranges::sort(slowdowns);
  return sized.copies > 0 && std::ranges::adjacent_find(slowdowns) == slowdowns.end();
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
