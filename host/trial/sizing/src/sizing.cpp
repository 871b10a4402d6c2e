#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include <fmt/format.h>

#include <tether/base/random.h>
#include <tether/sizing/sizing.h>

namespace tether::sizing {
namespace {

constexpr double kLeastFit = 0.01;
constexpr std::ptrdiff_t kFewMisses = 3;
// Every fourth flight looks for slowdowns below the threshold that are not sufficient.
constexpr std::size_t kOneOf = 4;

// The slowdown up to `most` where failures below the threshold are most likely: few flights are
// near it, or many of those near it failed (an upper confidence bound of their share). A gap is
// thus flown again until the check of the curve can see it.
double most_suspicious(std::span<const double> slowdowns, double most,
                       std::span<const Flight> flights, std::span<const double> planned) {
  constexpr double kNear = 0.12;  // log slowdown
  constexpr std::size_t kStep = 4;
  double best = slowdowns.front(), highest = -1.0;
  for (std::size_t i = 0; i < slowdowns.size() && slowdowns[i] <= most; i += kStep) {
    const auto nearness = [&](double other) {
      const double distance = std::log(slowdowns[i] / other) / kNear;
      return std::exp(-0.5 * distance * distance);
    };
    double near = 0.0, missed = 0.0;
    for (const Flight& flight : flights) {
      near += nearness(flight.slowdown);
      if (!flight.reached) missed += nearness(flight.slowdown);
    }
    for (const double other : planned) near += nearness(other);
    const double suspicion = (missed + 0.1) / (near + 1.0) + 0.5 / std::sqrt(near + 1.0);
    if (suspicion > highest) best = slowdowns[i], highest = suspicion;
  }
  return best;
}

double any_of(std::span<const double> slowdowns, std::size_t flight) {
  KeyedRandom random({flight, random_stream("", "", "neighbourhood of a slowdown"), 0});
  const double place = random.uniform() * static_cast<double>(slowdowns.size());
  return slowdowns[static_cast<std::size_t>(place)];
}

// Those around `slowdown`, as many as in a level; at an end of the range, those next to it.
std::span<const double> neighbourhood(const Question& question, std::span<const double> slowdowns,
                                      double slowdown) {
  const double reach = neighbourhood_reach(question);
  const double low = std::min(slowdown / reach, slowdowns.back() / (reach * reach));
  const double high = std::max(slowdown * reach, slowdowns.front() * (reach * reach));
  const auto begin = std::ranges::lower_bound(slowdowns, low);
  return {begin, std::ranges::upper_bound(slowdowns, high)};
}

}  // namespace

double neighbourhood_reach(const Question& question) {
  constexpr double kShareOfInterval = 0.4;
  return std::exp(0.5 * kShareOfInterval * std::log(question.interval));
}

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
  // If most flights miss the goal for what has no margin, margins say nothing of the threshold.
  const auto missed = std::ranges::count(flights_, false, &Flight::reached);
  const auto unexplained = std::ranges::count_if(
      flights_, [](const Flight& one) { return !one.reached && !one.margin; });
  if (basis_ == Basis::kMargins && missed >= kFewMisses && 2 * unexplained > missed)
    basis_ = Basis::kCurve;
}

const SuccessCurve& Sizing::curve() const {
  return basis_ == Basis::kMargins ? with_margins_ : without_;
}

Answer Sizing::current() const {
  const Question& question = grid_.question();
  Answer answer{.basis = basis_, .fit = fit_};
  bool is_done = false;
  if (basis_ == Basis::kLevels) {
    const LevelAnswer levels = answer_by_levels(question, flights_);
    answer.threshold = levels.threshold;
    is_done = levels.is_done;
  } else {
    answer.threshold = curve().threshold();
  }
  Threshold& threshold = answer.threshold;
  answer.is_above = threshold.low >= grid_.slowdowns().back();
  answer.is_below = threshold.high <= grid_.slowdowns().front();
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
  const std::vector<double>& slowdowns = grid_.slowdowns();
  const Question& question = grid_.question();
  std::vector<double> next;
  if (basis_ == Basis::kLevels) {
    const Level level = answer_by_levels(question, flights_).next;
    while (next.size() < count)
      next.push_back(any_of(level.slowdowns, flights_.size() + copies_ + next.size()));
    return next;
  }
  next = curve().next_slowdowns(count);
  const double estimate = curve().threshold().estimate;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t flight = flights_.size() + copies_ + i;
    if (flight % kOneOf == kOneOf - 1)
      next[i] = most_suspicious(slowdowns, estimate, flights_, std::span(next).first(i));
    next[i] = any_of(neighbourhood(question, slowdowns, next[i]), flight);
  }
  return next;
}

std::vector<std::size_t> Sizing::next_levels(std::size_t most) {
  latest_ = answer(most == 0);
  if (latest_.is_narrow || most == 0) return {};
  std::vector<std::size_t> levels;
  for (const double slowdown : next(most)) {
    const auto level = std::ranges::lower_bound(grid_.slowdowns(), slowdown);
    levels.push_back(static_cast<std::size_t>(level - grid_.slowdowns().begin()));
  }
  return levels;
}

// Bounds from few flights mislead: the final ones can be outside of them.
std::string Sizing::so_far() const {
  const Threshold& threshold = latest_.threshold;
  const bool is_bounded = threshold.low > 0.0 || std::isfinite(threshold.high);
  return threshold.estimate > 0.0 && is_bounded
             ? fmt::format("so far about {:.2g} × the computing time{}", threshold.estimate,
                           basis_ == Basis::kLevels ? ", by neighbourhoods: no curve fits" : "")
             : "no limit is known yet";
}

std::optional<std::size_t> Sizing::flights_left() const {
  const Threshold& threshold = latest_.threshold;
  const bool is_bounded = threshold.low > 0.0 && std::isfinite(threshold.high);
  if (basis_ == Basis::kLevels || !is_bounded || flights_.size() < kLeastFlights)
    return std::nullopt;
  const double wider =
      std::log(threshold.high / threshold.low) / std::log(grid_.question().interval);
  const double more = static_cast<double>(flights_.size()) * std::max(wider * wider - 1.0, 0.0);
  return static_cast<std::size_t>(std::ceil(more));
}

}  // namespace tether::sizing
