#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>

#include <boost/math/distributions/normal.hpp>

#include <tether/sizing/by_levels.h>

namespace tether::sizing {
namespace {

// Intervals are looked at again and again until a level is decided, at several levels.
constexpr double kLooks = 3.0;
constexpr std::size_t kMostFlights = 160;  // at a level that cannot be decided

// Every n-th level, so that an interval that is narrow enough spans two of them.
std::size_t stride(const Question& question, std::span<const double> levels) {
  if (levels.size() < 2) return 1;
  const double step =
      std::log(levels.back() / levels.front()) / static_cast<double>(levels.size() - 1);
  return std::max<std::size_t>(
      1, static_cast<std::size_t>(std::log(question.interval) / 2.0 / step + 0.1));
}

}  // namespace

Share wilson(std::size_t reached, std::size_t flights, double confidence) {
  const double n = static_cast<double>(flights), share = static_cast<double>(reached) / n;
  const double z = boost::math::quantile(boost::math::normal(), 0.5 + confidence / 2.0);
  const double centre = (share + z * z / (2.0 * n)) / (1.0 + z * z / n);
  const double reach =
      z / (1.0 + z * z / n) * std::sqrt(share * (1.0 - share) / n + z * z / (4.0 * n * n));
  return {share, std::max(0.0, centre - reach), std::min(1.0, centre + reach)};
}

std::vector<Level> levels_of(std::span<const Flight> flights, double confidence) {
  std::map<double, Level> levels;
  for (const Flight& flight : flights) {
    Level& level = levels[flight.slowdown];
    level.slowdown = flight.slowdown;
    ++level.flights;
    if (flight.reached) ++level.reached;
  }
  std::vector<Level> ascending;
  for (auto& [slowdown, level] : levels) {
    level.share = wilson(level.reached, level.flights, confidence);
    ascending.push_back(level);
  }
  return ascending;
}

LevelAnswer answer_by_levels(const Question& question, std::span<const double> levels,
                             std::span<const Flight> flights) {
  const double confidence = 1.0 - (1.0 - question.confidence) / kLooks;
  const std::vector<Level> flown = levels_of(flights, confidence);
  LevelAnswer answer;
  Threshold& threshold = answer.threshold;
  threshold.high = std::numeric_limits<double>::infinity();
  for (const Level& level : flown) {
    if (level.share.high < question.success) {
      threshold.high = level.slowdown;
      break;
    }
    if (level.share.low >= question.success) threshold.low = level.slowdown;
    if (level.share.estimate >= question.success) threshold.estimate = level.slowdown;
  }
  threshold.estimate = std::max(threshold.estimate, threshold.low);
  // First what may be insufficient below the bounds; then the middle of what is open, until it is
  // decided; where that takes too long, beside it.
  std::vector<std::size_t> open;
  for (const Level& level : flown) {
    const auto at = std::ranges::find(levels, level.slowdown);
    if (level.slowdown >= threshold.low || at == levels.end()) continue;
    if (level.share.estimate < question.success && level.flights < kMostFlights)
      return {threshold, static_cast<std::size_t>(at - levels.begin()), false};
  }
  for (std::size_t i = 0; i < levels.size(); i += stride(question, levels)) {
    if (levels[i] <= threshold.low || levels[i] >= threshold.high) continue;
    const auto at = std::ranges::find(flown, levels[i], &Level::slowdown);
    if (at == flown.end() || at->flights < kMostFlights) open.push_back(i);
  }
  answer.is_done = open.empty() || threshold.high <= question.interval * threshold.low;
  if (!answer.is_done) answer.next = open[open.size() / 2];
  return answer;
}

}  // namespace tether::sizing
