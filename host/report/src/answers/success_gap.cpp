#include "answers/success_gap.h"

#include <algorithm>
#include <functional>
#include <vector>

#include <tether/sizing/sizing.h>

namespace tether::report {
namespace {

// Most flights are near the limit, where some neighbours differ by chance.
constexpr double kSignificantGap = 0.01;

using Levels = std::vector<sizing::Level>;

/// The levels from `at` on for which `is_of_band` holds. Moves `at` behind them.
template <class Test>
Band band_from(Levels::const_iterator& at, const Levels& levels, const Test& is_of_band) {
  Band band;
  for (; at != levels.end() && is_of_band(*at); ++at) {
    if (band.flights.all == 0) band.from = at->slowdowns.front();
    band.to = at->slowdowns.back();
    band.flights.all += at->flights;
    band.flights.of_them += at->reached;
  }
  return band;
}

}  // namespace

std::optional<SuccessGap> success_gap(const SizeReport& report) {
  const sizing::Question& question = report.question;
  Levels levels = sizing::levels_of(question, report.synchronised.flights, question.confidence);
  std::erase_if(levels, [](const sizing::Level& level) { return level.flights == 0; });
  const bool is_certain = is_one_start(report.synchronised);
  const auto is_insufficient = [&](const sizing::Level& level) {
    return (is_certain ? level.share.estimate : level.share.high) < question.success;
  };
  const auto reaches = [&](const sizing::Level& level) {
    return level.share.estimate >= question.success;
  };
  for (auto at = levels.cbegin(); at != levels.cend();) {
    if (!is_insufficient(*at)) {
      ++at;
      continue;
    }
    SuccessGap gap;
    gap.fails = band_from(at, levels, std::not_fn(reaches));
    gap.again = band_from(at, levels, reaches);
    if (gap.again.flights.all > 0 &&
        (is_certain ||
         campaign::fisher_exact(gap.fails.flights, gap.again.flights) < kSignificantGap))
      return gap;
  }
  return std::nullopt;
}

}  // namespace tether::report
