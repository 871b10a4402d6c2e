#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include <tether/report/size_report.h>

namespace tether::report {
namespace {

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

std::string answer_sentence(const SizeReport& report) {
  const SizedCondition& sized = report.synchronised;
  const sizing::Threshold& threshold = sized.answer.threshold;
  const std::string evidence =
      fmt::format("{}; {} flights.", percent(report.question.confidence), sized.flights.size());
  if (sized.answer.is_below)
    return fmt::format(
        "Not sufficient: already at {} × the time of “{}”, fewer than {} of the flights reach the "
        "goal, {}",
        digits(report.question.least), sized.condition, percent(report.question.success), evidence);
  if (sized.answer.is_above)
    return fmt::format("Sufficient up to {} × slower than “{}”, the most that was flown, {}",
                       digits(report.question.most), sized.condition, evidence);
  const char* unit = threshold.estimate < 1.0 ? "the computing time of" : "slower than";
  return fmt::format("Sufficient up to {} × {} “{}” {}, {}", digits(threshold.estimate), unit,
                     sized.condition, interval_text(threshold, report.question), evidence);
}

std::string board_sentence(const Board& board, const sizing::Answer& answer) {
  const double headroom = answer.threshold.estimate / board.slowdown;
  const std::string name = fmt::format("{} ({} ×)", board.name, digits(board.slowdown));
  switch (verdict(board, answer)) {
    case BoardVerdict::kSuffices:
      return fmt::format("{} has {}{} × headroom.", name, answer.is_above ? "at least " : "",
                         digits(headroom));
    case BoardVerdict::kDoesNot:
      return fmt::format("{} is not sufficient: it is {}{} × too slow.", name,
                         answer.is_below ? "more than " : "", digits(1.0 / headroom));
    case BoardVerdict::kUndecided:
      break;
  }
  return fmt::format(
      "{} may not be sufficient: {}.", name,
      answer.is_above ? "no flight was as slow as that" : "it is too close to the limit");
}

std::string flattery_sentence(const SizeReport& report) {
  const SizedCondition& other = *report.unsynchronised;
  const double ratio =
      other.answer.threshold.estimate / report.synchronised.answer.threshold.estimate;
  return fmt::format(
      "Without synchronisation (“{}”), {}{} × slower would seem sufficient: {} × {}.",
      other.condition, other.answer.is_above ? "at least " : "",
      digits(other.answer.threshold.estimate), digits(ratio),
      ratio >= 1.0 ? "too much" : "of what really is");
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

BoardVerdict verdict(const Board& board, const sizing::Answer& answer) {
  const double low = board.low.value_or(board.slowdown), high = board.high.value_or(board.slowdown);
  if (high <= answer.threshold.low && !answer.is_below) return BoardVerdict::kSuffices;
  if (low >= answer.threshold.high && !answer.is_above) return BoardVerdict::kDoesNot;
  return BoardVerdict::kUndecided;
}

std::vector<std::string> size_sentences(const SizeReport& report) {
  const sizing::Answer& answer = report.synchronised.answer;
  std::vector<std::string> sentences = {answer_sentence(report)};
  for (const Board& board : report.boards) sentences.push_back(board_sentence(board, answer));
  if (report.unsynchronised) sentences.push_back(flattery_sentence(report));
  if (answer.basis == sizing::Basis::kLevels)
    sentences.push_back(
        "The success of the flights does not follow a smooth curve. The answer is that of single "
        "slowdowns: the interval is from the largest one that is sufficient to the smallest one "
        "that is not.");
  if (!answer.is_narrow)
    sentences.push_back(fmt::format(
        "The interval is wider than a factor of {}, because {}. More flights: --max-trials and "
        "--resume.",
        digits(report.question.interval),
        report.synchronised.flights.size() + report.not_flown.size() >= report.most_flights
            ? fmt::format("{} flights are the most that were allowed", report.most_flights)
            : "slowdowns in between could not be decided"));
  return sentences;
}

std::optional<double> margin_of(const campaign::MetricValue& metric) {
  const bool is_count = metric.unit == "1";
  if (!metric.value || is_count || !(metric.max || metric.min)) return std::nullopt;
  const double limit = metric.max ? *metric.max : *metric.min;
  const double within = metric.max ? limit - *metric.value : *metric.value - limit;
  if (limit == 0.0) return std::nullopt;
  return within / std::abs(limit);
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
