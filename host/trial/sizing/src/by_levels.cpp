#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include <boost/math/distributions/binomial.hpp>

#include <tether/sizing/sizing.h>

namespace tether::sizing {
namespace {

// Intervals are looked at again and again until a level is decided, at several levels.
constexpr double kLooks = 3.0;
constexpr std::size_t kMostFlights = 160;  // at a level that cannot be decided
constexpr double kLevelsInInterval = 2.5;

std::vector<Level> levels_without_flights(const Question& question) {
  const std::vector<double> slowdowns = slowdowns_of(question);
  const double width = std::log(question.interval) / kLevelsInInterval;
  const double range = std::log(slowdowns.back() / slowdowns.front());
  const std::size_t count =
      std::min(slowdowns.size(), static_cast<std::size_t>(std::ceil(std::max(range / width, 1.0))));
  std::vector<Level> levels(count);
  for (std::size_t i = 0; i < slowdowns.size(); ++i)
    levels[i * count / slowdowns.size()].slowdowns.push_back(slowdowns[i]);
  return levels;
}

}  // namespace

std::vector<double> slowdowns_of(const Question& question) {
  constexpr double kPerDecade = 160.0, kSame = 1e-9;
  std::vector<double> slowdowns;
  for (double k = std::floor(kPerDecade * std::log10(question.least)) - 1.0;; k += 1.0) {
    const double exact = std::pow(10.0, k / kPerDecade);
    const double digits = std::pow(10.0, 2.0 - std::floor(k / kPerDecade));
    const double slowdown = std::round(exact * digits) / digits;
    if (slowdown > question.most * (1.0 + kSame)) return slowdowns;
    if (slowdown >= question.least * (1.0 - kSame)) slowdowns.push_back(slowdown);
  }
}

Share exact_share(std::size_t reached, std::size_t flights, double confidence) {
  using Binomial = boost::math::binomial_distribution<double>;
  const double n = static_cast<double>(flights), k = static_cast<double>(reached);
  const double tail = (1.0 - confidence) / 2.0;
  return {k / n, reached == 0 ? 0.0 : Binomial::find_lower_bound_on_p(n, k, tail),
          reached == flights ? 1.0 : Binomial::find_upper_bound_on_p(n, k, tail)};
}

std::vector<Level> levels_of(const Question& question, std::span<const Flight> flights,
                             double confidence) {
  std::vector<Level> levels = levels_without_flights(question);
  for (const Flight& flight : flights) {
    const auto beyond = std::ranges::upper_bound(
        levels, flight.slowdown, {}, [](const Level& level) { return level.slowdowns.front(); });
    Level& level = beyond == levels.begin() ? levels.front() : *(beyond - 1);
    ++level.flights;
    if (flight.reached) ++level.reached;
  }
  for (Level& level : levels)
    level.share = level.flights > 0 ? exact_share(level.reached, level.flights, confidence)
                                    : Share{0.0, 0.0, 1.0};
  return levels;
}

LevelAnswer answer_by_levels(const Question& question, std::span<const Flight> flights) {
  const double confidence = 1.0 - (1.0 - question.confidence) / kLooks;
  const std::vector<Level> levels = levels_of(question, flights, confidence);
  LevelAnswer answer;
  Threshold& threshold = answer.threshold;
  threshold.high = std::numeric_limits<double>::infinity();
  // Levels from `open` up to `end` may be decided by more flights.
  std::size_t open = 0, end = levels.size();
  for (std::size_t i = 0; i < end; ++i) {
    const Level& level = levels[i];
    if (level.share.high < question.success) {
      threshold.high = i == 0 ? level.slowdowns.front() : level.slowdowns.back();
      end = i;
      break;
    }
    const bool is_last = i + 1 == levels.size();
    const double slowdown = is_last ? level.slowdowns.back() : level.middle();
    if (level.share.low >= question.success) threshold.low = slowdown, open = i + 1;
    if (level.share.estimate >= question.success) threshold.estimate = slowdown;
  }
  threshold.estimate = std::max(threshold.estimate, threshold.low);
  // First what may be insufficient below the bounds; then the middle of what is open, until it is
  // decided; where that takes too long, beside it.
  for (std::size_t i = 0; i < open; ++i) {
    const Level& level = levels[i];
    const bool is_doubtful = level.flights > 0 && level.share.estimate < question.success;
    if (is_doubtful && level.flights < kMostFlights) return {threshold, level, false};
  }
  std::vector<const Level*> undecided;
  for (std::size_t i = open; i < end; ++i)
    if (levels[i].flights < kMostFlights) undecided.push_back(&levels[i]);
  answer.is_done = undecided.empty() || threshold.high <= question.interval * threshold.low;
  if (!answer.is_done) answer.next = *undecided[undecided.size() / 2];
  return answer;
}

}  // namespace tether::sizing
