#include "outcome_model.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numeric>
#include <utility>

#include <tether/base/random.h>
#include <tether/sizing/success_curve.h>

// A posterior is a weight for each curve of the grid and each scale of the margin.
namespace tether::sizing {
namespace {

constexpr double kReach = 1.2;   // of the grid beyond the flown slowdowns, log
constexpr double kWidest = 0.8;  // log slowdown: 10 to 90 % over a factor of 33
constexpr std::size_t kWidths = 8;
// Margin per log slowdown. Where margins are ignored, there is one.
constexpr std::size_t kScales = 20;
constexpr double kLeastScale = 0.1, kMostScale = 10.0;
constexpr float kNegligible = 1e-4F;  // weight relative to the largest
constexpr double kTried = 2.5;        // next flights: up to so far beyond the threshold's interval

double log_spaced(double low, double high, std::size_t i, std::size_t count) {
  return low * std::pow(high / low, static_cast<double>(i) / static_cast<double>(count - 1));
}

double scale(std::size_t i) {
  return log_spaced(kLeastScale, kMostScale, i, kScales);
}

std::vector<double> levels_between(double least, double most) {
  constexpr double kPerDecade = 40.0, kSame = 1e-9;
  std::vector<double> levels;
  for (double k = std::floor(kPerDecade * std::log10(least)) - 1.0;; k += 1.0) {
    const double exact = std::pow(10.0, k / kPerDecade);
    const double digits = std::pow(10.0, 2.0 - std::floor(k / kPerDecade));
    const double level = std::round(exact * digits) / digits;
    if (level > most * (1.0 + kSame)) return levels;
    if (level >= least * (1.0 - kSame)) levels.push_back(level);
  }
}

}  // namespace

double CurveGrid::Curve::share(double log_slowdown) const {
  const double follows = 1.0 / (1.0 + std::exp((log_slowdown - middle) / width));
  return ends->floor + (1.0 - ends->floor - ends->lapses) * follows;
}

CurveGrid::CurveGrid(const Question& question)
    : question_(question), levels_(levels_between(question.least, question.most)) {
  // Lapses and a floor are rare, but with more lapses than 1 − success no slowdown is sufficient.
  constexpr std::pair<double, double> kLapses[] = {
      {0.0, 3.0}, {0.015, 3.0}, {0.035, 2.0}, {0.07, 1.0}, {0.14, 0.4}};
  constexpr std::pair<double, double> kFloors[] = {{0.0, 6.0}, {0.2, 2.0}, {0.5, 1.0}};
  for (const auto& [lapses, lapse_prior] : kLapses)
    for (const auto& [floor, floor_prior] : kFloors)
      ends_.push_back({lapses, floor, lapse_prior * floor_prior});
  const double step = std::clamp(std::log(question.interval) / 7.0, 0.005, 0.04);
  const double first = std::log(question.least) - kReach, last = std::log(question.most) + kReach;
  for (double middle = first; middle <= last; middle += step) middles_.push_back(middle);
  for (std::size_t i = 0; i < kWidths; ++i)
    widths_.push_back(log_spaced(0.75 * step, kWidest, i, kWidths));
  for (const double middle : middles_)
    for (const double width : widths_)
      for (const Ends& ends : ends_) add_curve(middle, width, ends, first, last);
  by_threshold_.resize(curves_.size());
  std::iota(by_threshold_.begin(), by_threshold_.end(), std::size_t{0});
  std::stable_sort(by_threshold_.begin(), by_threshold_.end(),
                   [&](std::size_t a, std::size_t b) { return threshold_[a] < threshold_[b]; });
  for (const double level : levels_) {
    success_.emplace_back();
    for (const Curve& curve : curves_)
      success_.back().push_back(static_cast<float>(curve.share(std::log(level))));
  }
}

void CurveGrid::add_curve(double middle, double width, const Ends& ends, double first,
                          double last) {
  curves_.push_back({middle, width, &ends});
  const double logistic =
      (question_.success - ends.floor) / (1.0 - ends.floor - ends.lapses);  // at the threshold
  double threshold = middle - width * std::log(logistic / (1.0 - logistic));
  if (logistic >= 1.0) threshold = first;
  if (logistic <= 0.0) threshold = last;
  threshold_.push_back(static_cast<float>(std::clamp(threshold, first, last)));
}

SuccessCurve::SuccessCurve(const CurveGrid& grid, Margins margins)
    : grid_(grid), scales_(margins == Margins::kLinear ? kScales : 1) {
  for (const CurveGrid::Curve& curve : grid.curves_)
    joint_.insert(joint_.end(), scales_, static_cast<float>(curve.ends->prior));
  normalise();
}

void SuccessCurve::observe(const Flight& flight) {
  const double x = std::log(flight.slowdown);
  Flight seen = flight;
  if (scales_ == 1) seen.margin.reset();
  const std::size_t ends = grid_.ends_.size();
  for (std::size_t i = 0; i < grid_.curves_.size(); i += ends) {
    const CurveGrid::Curve& curve = grid_.curves_[i];
    for (std::size_t k = 0; k < scales_; ++k) {
      const Likelihood parts =
          likelihood(seen, (curve.middle - x) / curve.width, scale(k) * curve.width);
      for (std::size_t e = 0; e < ends; ++e) {
        const auto& [lapses, floor, prior] = grid_.ends_[e];
        joint_[(i + e) * scales_ + k] *= static_cast<float>(
            (1.0 - lapses - floor) * parts.curve + lapses * parts.lapse + floor * parts.floor);
      }
    }
  }
  normalise();
}

void SuccessCurve::normalise() {
  weight_.assign(grid_.curves_.size(), 0.0F);
  for (std::size_t i = 0; i < weight_.size(); ++i)
    for (std::size_t k = 0; k < scales_; ++k) weight_[i] += joint_[i * scales_ + k];
  const double sum = std::accumulate(weight_.begin(), weight_.end(), 0.0);
  assert(sum > 0.0);
  const auto factor = static_cast<float>(1.0 / sum);
  for (float& weight : weight_) weight *= factor;
  for (float& weight : joint_) weight *= factor;
}

Threshold SuccessCurve::threshold() const {
  const double tail = (1.0 - grid_.question_.confidence) / 2.0;
  const std::array wanted = {tail, 0.5, 1.0 - tail};
  std::array<double, 3> found;
  found.fill(grid_.threshold_[grid_.by_threshold_.back()]);
  std::size_t next = 0;
  double sum = 0.0;
  for (const std::size_t i : grid_.by_threshold_) {
    sum += weight_[i];
    while (next < wanted.size() && sum >= wanted[next]) found[next++] = grid_.threshold_[i];
  }
  return {std::exp(found[1]), std::exp(found[0]), std::exp(found[2])};
}

Share SuccessCurve::share(double slowdown) const {
  const double x = std::log(slowdown), tail = (1.0 - grid_.question_.confidence) / 2.0;
  std::vector<std::pair<double, double>> shares;
  Share share;
  for (std::size_t i = 0; i < weight_.size(); ++i) {
    shares.emplace_back(grid_.curves_[i].share(x), weight_[i]);
    share.estimate += shares.back().first * shares.back().second;
  }
  std::sort(shares.begin(), shares.end());
  share.low = share.high = shares.front().first;
  double sum = 0.0;
  for (const auto& [value, weight] : shares) {
    if (sum < tail) share.low = value;
    if (sum < 1.0 - tail) share.high = value;
    sum += weight;
  }
  return share;
}

std::vector<double> SuccessCurve::next_levels(std::size_t count) const {
  // The curves that matter.
  const float least = kNegligible * *std::max_element(weight_.begin(), weight_.end());
  std::vector<std::size_t> active;
  std::vector<float> weights, thresholds;
  for (std::size_t i = 0; i < weight_.size(); ++i) {
    if (weight_[i] < least) continue;
    active.push_back(i);
    weights.push_back(weight_[i]);
    thresholds.push_back(grid_.threshold_[i]);
  }
  const Threshold so_far = threshold();
  std::vector<std::size_t> tried;
  for (std::size_t level = 0; level < grid_.levels_.size(); ++level) {
    const double slowdown = grid_.levels_[level];
    if (slowdown * kTried >= so_far.low && slowdown <= so_far.high * kTried) tried.push_back(level);
  }
  if (tried.empty()) tried = {so_far.high < grid_.levels_.front() ? 0 : grid_.levels_.size() - 1};
  std::vector<double> levels;
  while (levels.size() < count) {
    float all = 0.0F, all_sum = 0.0F;
    for (std::size_t i = 0; i < active.size(); ++i) {
      all += weights[i];
      all_sum += weights[i] * thresholds[i];
    }
    // The expected variance after a flight is E t² − Σ (E t; outcome)² / P(outcome) over both
    // outcomes: the sum is to be large.
    float best = -1.0F, best_share = 0.0F;
    std::size_t best_level = 0;
    for (const std::size_t level : tried) {
      const std::vector<float>& success = grid_.success_[level];
      float reached = 0.0F, sum = 0.0F;
      for (std::size_t i = 0; i < active.size(); ++i) {
        const float product = weights[i] * success[active[i]];
        reached += product;
        sum += product * thresholds[i];
      }
      const float missed = all - reached, missed_sum = all_sum - sum;
      const float gain = (reached > 0.0F ? sum * sum / reached : 0.0F) +
                         (missed > 0.0F ? missed_sum * missed_sum / missed : 0.0F);
      if (gain > best) best = gain, best_level = level, best_share = reached / all;
    }
    levels.push_back(grid_.levels_[best_level]);
    for (std::size_t i = 0; i < active.size(); ++i) {
      const float success = grid_.success_[best_level][active[i]];
      weights[i] *= std::pow(success, best_share) * std::pow(1.0F - success, 1.0F - best_share);
    }
  }
  return levels;
}

std::size_t SuccessCurve::draw(double uniform) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < weight_.size(); ++i) {
    if (sum + weight_[i] <= uniform) {
      sum += weight_[i];
      continue;
    }
    for (std::size_t k = 0; k < scales_; ++k) {
      sum += joint_[i * scales_ + k];
      if (sum > uniform) return i * scales_ + k;
    }
    return i * scales_ + scales_ - 1;
  }
  return joint_.size() - 1;
}

namespace {

constexpr std::size_t kDraws = 300;
constexpr std::size_t kFlightsInGroup = 6;

// The flights by slowdown; each group of about the same number.
std::vector<std::vector<Flight>> groups_of(std::span<const Flight> flights) {
  std::vector<Flight> sorted(flights.begin(), flights.end());
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const Flight& a, const Flight& b) { return a.slowdown < b.slowdown; });
  std::vector<std::vector<Flight>> groups;
  for (const Flight& flight : sorted) {
    const bool is_full = !groups.empty() && groups.back().size() >= kFlightsInGroup &&
                         groups.back().back().slowdown != flight.slowdown;
    if (groups.empty() || is_full) groups.emplace_back();
    groups.back().push_back(flight);
  }
  return groups;
}

// How far counts are from what is expected.
double deviation(const std::array<double, kMostKinds>& counts,
                 const std::array<double, kMostKinds>& expected) {
  constexpr double kLeast = 0.5;  // so that one flight where none is expected is not everything
  double sum = 0.0;
  for (std::size_t i = 0; i < kMostKinds; ++i)
    sum += (counts[i] - expected[i]) * (counts[i] - expected[i]) / (expected[i] + kLeast);
  return sum;
}

}  // namespace

double SuccessCurve::fit(std::span<const Flight> flights) const {
  const bool with_margins = scales_ > 1;
  const std::vector<std::vector<Flight>> groups = groups_of(flights);
  KeyedRandom random({flights.size(), random_stream("", "", "fit of a success curve"), 0});
  std::size_t as_far = 0, as_far_somewhere = 0;
  for (std::size_t draw_index = 0; draw_index < kDraws; ++draw_index) {
    const std::size_t drawn = draw(random.uniform());
    const CurveGrid::Curve& curve = grid_.curves_[drawn / scales_];
    double observed = 0.0, replicated = 0.0, observed_most = 0.0, replicated_most = 0.0;
    for (const std::vector<Flight>& group : groups) {
      std::array<double, kMostKinds> expected{}, counts{}, replica{};
      for (const Flight& flight : group) {
        const auto kinds =
            kind_probabilities((curve.middle - std::log(flight.slowdown)) / curve.width,
                               scale(drawn % scales_) * curve.width, with_margins);
        double left = random.uniform();
        bool is_drawn = false;
        for (std::size_t kind = 0; kind < kMostKinds; ++kind) {
          const auto& [lapses, floor, prior] = *curve.ends;
          const double probability = (1.0 - lapses - floor) * kinds[kind].curve +
                                     lapses * kinds[kind].lapse + floor * kinds[kind].floor;
          expected[kind] += probability;
          left -= probability;
          if (left < 0.0 && !is_drawn) replica[kind] += 1.0, is_drawn = true;
        }
        counts[kind_of(flight, with_margins)] += 1.0;
      }
      const double own = deviation(counts, expected), drawn_one = deviation(replica, expected);
      observed += own;
      replicated += drawn_one;
      observed_most = std::max(observed_most, own);
      replicated_most = std::max(replicated_most, drawn_one);
    }
    if (replicated >= observed) ++as_far;
    if (replicated_most >= observed_most) ++as_far_somewhere;
  }
  const auto least = static_cast<double>(std::min(as_far, as_far_somewhere));
  return std::min(1.0, 2.0 * least / static_cast<double>(kDraws));
}

}  // namespace tether::sizing
