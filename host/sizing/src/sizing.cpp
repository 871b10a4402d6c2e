#include <algorithm>
#include <cmath>
#include <limits>

#include <tether/sizing/sizing.h>

namespace tether::sizing {
namespace {

constexpr std::size_t kLeastFlights = 12;  // so that chance outcomes of the first do not decide
constexpr double kLeastFit = 0.01;
// Every fourth flight looks for slowdowns below the threshold that are not sufficient.
constexpr std::size_t kOneOf = 4;

// The level up to `most` where failures below the threshold are most likely: few flights are near
// it, or many of those near it failed (an upper confidence bound of their share). A gap is thus
// flown again until the check of the curve can see it.
double most_suspicious(std::span<const double> levels, double most, std::span<const Flight> flights,
                       std::span<const double> planned) {
  constexpr double kNear = 0.12;  // log slowdown
  double best = levels.front(), highest = -1.0;
  for (const double level : levels) {
    if (level > most) break;
    const auto nearness = [&](double other) {
      const double distance = std::log(level / other) / kNear;
      return std::exp(-0.5 * distance * distance);
    };
    double near = 0.0, missed = 0.0;
    for (const Flight& flight : flights) {
      near += nearness(flight.slowdown);
      if (!flight.reached) missed += nearness(flight.slowdown);
    }
    for (const double other : planned) near += nearness(other);
    const double suspicion = (missed + 0.1) / (near + 1.0) + 0.5 / std::sqrt(near + 1.0);
    if (suspicion > highest) best = level, highest = suspicion;
  }
  return best;
}

}  // namespace

Sizing::Sizing(const CurveGrid& grid, bool has_margins)
    : grid_(grid),
      with_margins_(grid,
                    has_margins ? SuccessCurve::Margins::kLinear : SuccessCurve::Margins::kIgnored),
      without_(grid, SuccessCurve::Margins::kIgnored),
      basis_(has_margins ? Basis::kMargins : Basis::kCurve) {}

void Sizing::add(const Flight& flight) {
  if (basis_ == Basis::kMargins) with_margins_.observe(flight);
  without_.observe(flight);
  flights_.push_back(flight);
}

const SuccessCurve& Sizing::curve() const {
  return basis_ == Basis::kMargins ? with_margins_ : without_;
}

Answer Sizing::current() const {
  const Question& question = grid_.question();
  Answer answer{.basis = basis_, .fit = fit_};
  bool is_done = false;
  if (basis_ == Basis::kLevels) {
    const LevelAnswer levels = answer_by_levels(question, grid_.levels(), flights_);
    answer.threshold = levels.threshold;
    is_done = levels.is_done;
  } else {
    answer.threshold = curve().threshold();
  }
  Threshold& threshold = answer.threshold;
  answer.is_above = threshold.low >= grid_.levels().back();
  answer.is_below = threshold.high <= grid_.levels().front();
  is_done = is_done || answer.is_above || answer.is_below ||
            threshold.high <= question.interval * threshold.low;
  answer.is_narrow = is_done && flights_.size() >= kLeastFlights;
  if (threshold.low < question.least) threshold.low = 0.0;
  if (threshold.high > question.most) threshold.high = std::numeric_limits<double>::infinity();
  if (answer.is_above) threshold.low = question.most;
  if (answer.is_below) threshold.high = question.least;
  threshold.estimate = std::clamp(threshold.estimate, question.least, question.most);
  return answer;
}

Answer Sizing::answer(bool is_last) {
  for (;;) {
    const Answer now = current();
    if (basis_ == Basis::kLevels || !(now.is_narrow || is_last)) return now;
    fit_ = curve().fit(flights_);
    if (fit_ >= kLeastFit) return current();
    basis_ = basis_ == Basis::kMargins ? Basis::kCurve : Basis::kLevels;
  }
}

std::vector<double> Sizing::next(std::size_t count) const {
  const std::vector<double>& levels = grid_.levels();
  if (basis_ == Basis::kLevels)
    return std::vector<double>(count,
                               levels[answer_by_levels(grid_.question(), levels, flights_).next]);
  std::vector<double> next = curve().next_levels(count);
  const double estimate = curve().threshold().estimate;
  for (std::size_t i = 0; i < count; ++i) {
    if ((flights_.size() + i) % kOneOf == kOneOf - 1)
      next[i] = most_suspicious(levels, estimate, flights_, std::span(next).first(i));
  }
  return next;
}

}  // namespace tether::sizing
