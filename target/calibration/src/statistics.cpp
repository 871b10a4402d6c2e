#include "statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <tether/base/result.h>
#include <tether/base/text.h>
#include <tether/stats/sample_statistics.h>

// Compares two machines block by block: the factor of the medians, with an interval from order
// statistics. `doubts` lists signs that a measurement was disturbed.
namespace tether::calibration {
namespace {

using stats::quantile;

double median(const std::vector<double>& values) {
  return quartiles(values).median;
}

/// The greatest k of which a fair coin that is thrown n times shows heads less than k times with a
/// probability of at most `tail`.
std::size_t rank_of_tail(std::size_t n, double tail) {
  double term = std::pow(0.5, static_cast<double>(n)), sum = term;
  std::size_t k = 0;
  while (sum <= tail) {
    ++k;
    term *= static_cast<double>(n - k + 1) / static_cast<double>(k);
    sum += term;
  }
  return k;
}

const BlockTimes* find_block(const Calibration& calibration, const std::string& name) {
  const auto found = std::find_if(calibration.blocks.begin(), calibration.blocks.end(),
                                  [&](const BlockTimes& block) { return block.name == name; });
  return found == calibration.blocks.end() ? nullptr : &*found;
}

bool has_enough_rounds(const Calibration& calibration) {
  return std::all_of(
      calibration.blocks.begin(), calibration.blocks.end(),
      [](const BlockTimes& block) { return block.cpu_ms.size() >= std::size_t{kLeastRounds}; });
}

Factor factor_of(const BlockTimes& here, const BlockTimes& there) {
  const Interval a = median_interval(here.cpu_ms), b = median_interval(there.cpu_ms);
  return {here.name, median(there.cpu_ms) / median(here.cpu_ms), {b.low / a.high, b.high / a.low}};
}

bool is_whole(const Factor& factor) {
  return factor.block == kWholeStep;
}

Factor geometric_mean(const std::vector<Factor>& factors) {
  double value = 0.0, low = 0.0, high = 0.0;
  int count = 0;
  for (const Factor& factor : factors) {
    if (is_whole(factor)) continue;
    value += std::log(factor.value);
    low += std::log(factor.interval.low);
    high += std::log(factor.interval.high);
    ++count;
  }
  return {"overall", std::exp(value / count), {std::exp(low / count), std::exp(high / count)}};
}

bool is_less(const Factor& a, const Factor& b) {
  return a.value < b.value;
}

// Doubts ------------------------------------------------------------------------------------------

std::string whole_percent(double share) {
  return fixed(100.0 * share, 0) + " %";
}

void doubt_load(const BlockTimes& whole, std::vector<std::string>& doubts) {
  const double excess = median(whole.wall_ms) / median(whole.cpu_ms) - 1.0;
  if (excess > 0.1) {
    doubts.push_back("wall time is " + whole_percent(excess) +
                     " above CPU time: other programs used this core");
  }
}

void doubt_drift(const BlockTimes& whole, std::vector<std::string>& doubts) {
  const auto third = static_cast<std::ptrdiff_t>(whole.cpu_ms.size() / 3);
  if (third == 0) return;
  const double first = median({whole.cpu_ms.begin(), whole.cpu_ms.begin() + third});
  const double last = median({whole.cpu_ms.end() - third, whole.cpu_ms.end()});
  if (last > 1.05 * first) {
    doubts.push_back("the last rounds took " + whole_percent(last / first - 1.0) +
                     " longer than the first: the clock rate fell (heat, power), or load rose");
  } else if (first > 1.05 * last) {
    doubts.push_back("the first rounds took " + whole_percent(first / last - 1.0) +
                     " longer than the last: the clock rate rose (governor), or load fell");
  }
}

void doubt_scatter(const BlockTimes& whole, std::vector<std::string>& doubts) {
  const double spread = quartiles(whole.cpu_ms).spread();
  if (spread > 0.1) {
    doubts.push_back("times scatter: the quartiles are " + whole_percent(spread) + " apart");
  }
}

void doubt_clock_rate(const Machine& machine, std::vector<std::string>& doubts) {
  const double before = machine.mhz_before, after = machine.mhz_after;
  if (before > 0.0 && after > 0.0 && std::abs(after / before - 1.0) > 0.05) {
    doubts.push_back("the core's clock rate was " + fixed(before, 0) + " MHz before and " +
                     fixed(after, 0) + " MHz after");
  }
}

}  // namespace

Quartiles quartiles(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return {quantile(values, 0.25), quantile(values, 0.5), quantile(values, 0.75)};
}

Interval median_interval(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t rank = std::max<std::size_t>(rank_of_tail(values.size(), 0.0125), 1);
  return {values[rank - 1], values[values.size() - rank]};
}

const Factor& Comparison::least() const {
  return *std::min_element(blocks.begin(), blocks.end() - 1, is_less);
}

const Factor& Comparison::greatest() const {
  return *std::max_element(blocks.begin(), blocks.end() - 1, is_less);
}

Result<Comparison> compare(const Calibration& here, const Calibration& there) {
  if (!has_enough_rounds(here) || !has_enough_rounds(there)) {
    return invalid("a comparison needs at least " + std::to_string(kLeastRounds) + " rounds");
  }
  Comparison comparison;
  for (const BlockTimes& block : here.blocks) {
    const BlockTimes* other = find_block(there, block.name);
    if (other == nullptr || here.blocks.size() != there.blocks.size()) {
      return invalid("the two measurements have different blocks");
    }
    comparison.blocks.push_back(factor_of(block, *other));
  }
  std::stable_partition(comparison.blocks.begin(), comparison.blocks.end(),
                        [](const Factor& factor) { return !is_whole(factor); });
  if (comparison.blocks.size() < 2 || !is_whole(comparison.blocks.back())) {
    return invalid("the measurements lack the block \"" + std::string(kWholeStep) +
                   "\", or any other");
  }
  comparison.overall = geometric_mean(comparison.blocks);
  comparison.whole = comparison.blocks.back();
  return comparison;
}

std::vector<std::string> doubts(const Calibration& calibration) {
  std::vector<std::string> doubts;
  if (const BlockTimes* whole = find_block(calibration, kWholeStep)) {
    doubt_load(*whole, doubts);
    doubt_drift(*whole, doubts);
    doubt_scatter(*whole, doubts);
  }
  doubt_clock_rate(calibration.machine, doubts);
  return doubts;
}

}  // namespace tether::calibration
