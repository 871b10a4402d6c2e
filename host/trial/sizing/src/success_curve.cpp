#include "outcome_model.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>

#include <tether/base/random.h>
#include <tether/sizing/sizing.h>

// A posterior is a weight for each curve of the grid and each scale of the margin.
namespace tether::sizing {
namespace {

constexpr double kReach = 1.2;   // of the grid beyond the flown slowdowns, log
constexpr double kWidest = 0.8;  // log slowdown: 10 to 90 % over a factor of 33
constexpr std::size_t kWidths = 8;
constexpr std::size_t kPlanned = 4;  // one of so many slowdowns is planned
// Margin per log slowdown. Where margins are ignored, there is one.
constexpr std::size_t kScales = 20;
constexpr double kLeastScale = 0.1, kMostScale = 10.0;
constexpr double kLost = 1e-25;  // curves with less weight are left out from then on
constexpr std::size_t kEnds = 16;
constexpr float kLeastShare = 1e-6F;
constexpr float kNegligible = 1e-4F;  // weight relative to the largest
constexpr double kTried = 2.5;        // next flights: up to so far beyond the threshold's interval

double log_spaced(double low, double high, std::size_t i, std::size_t count) {
  return low * std::pow(high / low, static_cast<double>(i) / static_cast<double>(count - 1));
}

const std::array<double, kScales> kAllScales = [] {
  std::array<double, kScales> all{};
  for (std::size_t i = 0; i < kScales; ++i)
    all[i] = log_spaced(kLeastScale, kMostScale, i, kScales);
  return all;
}();

// Sums over curves of one middle and width: of the weights, and (…_sum) of weights times threshold;
// of the share's constant part, and of the part that is proportional to how they follow.
struct LinearInFollows {
  float all = 0.0F, all_sum = 0.0F, floor = 0.0F, floor_sum = 0.0F, span = 0.0F, span_sum = 0.0F;
};

}  // namespace

double CurveGrid::Curve::follows(double log_slowdown) const {
  return 1.0 / (1.0 + std::exp((log_slowdown - middle) / width));
}

double CurveGrid::Curve::share(double log_slowdown) const {
  return ends->floor + (1.0 - ends->floor - ends->lapses) * follows(log_slowdown);
}

CurveGrid::CurveGrid(const Question& question)
    : question_(question), slowdowns_(slowdowns_of(question)) {
  // Lapses and a floor are rare, but with more lapses than 1 − success no slowdown is sufficient.
  constexpr std::pair<double, double> kLapses[] = {
      {0.0, 3.0}, {0.015, 3.0}, {0.035, 2.0}, {0.07, 1.0}, {0.14, 0.4}};
  constexpr std::pair<double, double> kFloors[] = {{0.0, 6.0}, {0.2, 2.0}, {0.5, 1.0}};
  for (const auto& [lapses, lapse_prior] : kLapses)
    for (const auto& [floor, floor_prior] : kFloors)
      ends_.push_back({lapses, floor, lapse_prior * floor_prior});
  ends_.resize(kEnds);  // a number that suits vector instructions; the last has no prior
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
  for (std::size_t i = 0; i < slowdowns_.size(); i += kPlanned) planned_.push_back(slowdowns_[i]);
  for (const double slowdown : planned_) {
    follows_.emplace_back();
    for (std::size_t i = 0; i < curves_.size(); i += ends_.size())
      follows_.back().push_back(static_cast<float>(curves_[i].follows(std::log(slowdown))));
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
  // Beside its logarithmic steps, the prior rises with the square root of the width: flights must
  // show that a curve is steep, because a search that takes a flat one for steep ends too early.
  for (std::size_t i = 0; i < grid.curves_.size() / kEnds * scales_; ++i)
    for (std::size_t e = 0; e < kEnds; ++e)
      joint_.push_back(static_cast<float>(grid.ends_[e].prior *
                                          std::sqrt(grid.curves_[i / scales_ * kEnds].width)));
  normalise();
}

void SuccessCurve::observe(const Flight& flight) {
  const double x = std::log(flight.slowdown);
  Flight seen = flight;
  if (scales_ == 1) seen.margin.reset();
  std::array<float, kEnds> lapses{}, floors{}, follows{};
  for (std::size_t e = 0; e < kEnds; ++e) {
    lapses[e] = static_cast<float>(grid_.ends_[e].lapses);
    floors[e] = static_cast<float>(grid_.ends_[e].floor);
    follows[e] = 1.0F - lapses[e] - floors[e];
  }
  for (std::size_t i = 0; i < grid_.curves_.size(); i += kEnds) {
    const CurveGrid::Curve& curve = grid_.curves_[i];
    for (std::size_t k = 0; k < scales_; ++k) {
      const std::size_t block = i / kEnds * scales_ + k;
      if (!is_kept_[block]) continue;
      const Likelihood parts =
          likelihood(seen, (curve.middle - x) / curve.width, kAllScales[k] * curve.width);
      const auto by_curve = static_cast<float>(parts.curve);
      const auto by_lapse = static_cast<float>(parts.lapse);
      const auto by_floor = static_cast<float>(parts.floor);
      float* const joint = &joint_[block * kEnds];
      for (std::size_t e = 0; e < kEnds; ++e)
        joint[e] *= follows[e] * by_curve + lapses[e] * by_lapse + floors[e] * by_floor;
    }
  }
  normalise();
}

void SuccessCurve::normalise() {
  threshold_.reset();
  weight_.assign(grid_.curves_.size(), 0.0F);
  std::vector<float> of_blocks(joint_.size() / kEnds, 0.0F);
  double sum = 0.0;
  for (std::size_t block = 0; block < of_blocks.size(); ++block) {
    const float* const joint = &joint_[block * kEnds];
    float* const weight = &weight_[block / scales_ * kEnds];
    for (std::size_t e = 0; e < kEnds; ++e) weight[e] += joint[e];
    for (std::size_t e = 0; e < kEnds; ++e) of_blocks[block] += joint[e];
    sum += of_blocks[block];
  }
  assert(sum > 0.0);
  const auto factor = static_cast<float>(1.0 / sum);
  for (float& weight : weight_) weight *= factor;
  is_kept_.resize(of_blocks.size());
  for (std::size_t block = 0; block < is_kept_.size(); ++block) {
    is_kept_[block] = of_blocks[block] >= kLost * sum;
    float* const joint = &joint_[block * kEnds];
    const float scaled = is_kept_[block] ? factor : 0.0F;
    for (std::size_t e = 0; e < kEnds; ++e) joint[e] *= scaled;
  }
}

Threshold SuccessCurve::threshold() const {
  if (threshold_) return *threshold_;
  const double tail = (1.0 - grid_.question_.confidence) / 2.0;
  const std::array wanted = {tail, 0.5, 1.0 - tail};
  std::array<double, 3> found;
  found.fill(grid_.threshold_[grid_.by_threshold_.back()]);
  std::size_t next = 0;
  double sum = 0.0;
  for (const std::size_t i : grid_.by_threshold_) {
    sum += weight_[i];
    while (next < wanted.size() && sum >= wanted[next]) found[next++] = grid_.threshold_[i];
    if (next == wanted.size()) break;
  }
  threshold_ = {std::exp(found[1]), std::exp(found[0]), std::exp(found[2])};
  return *threshold_;
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

std::vector<double> SuccessCurve::next_slowdowns(std::size_t count) const {
  const std::vector<CurveGrid::Ends>& ends = grid_.ends_;
  // The pairs of middle and width that matter.
  const float least = kNegligible * *std::max_element(weight_.begin(), weight_.end());
  std::vector<std::size_t> active;
  std::vector<float> weights;
  for (std::size_t pair = 0; pair * ends.size() < weight_.size(); ++pair) {
    const float* const own = &weight_[pair * ends.size()];
    if (*std::max_element(own, own + ends.size()) < least) continue;
    active.push_back(pair);
    weights.insert(weights.end(), own, own + ends.size());
  }
  const Threshold so_far = threshold();
  std::vector<std::size_t> tried;
  for (std::size_t i = 0; i < grid_.planned_.size(); ++i) {
    const double slowdown = grid_.planned_[i];
    if (slowdown * kTried >= so_far.low && slowdown <= so_far.high * kTried) tried.push_back(i);
  }
  if (tried.empty()) tried = {so_far.high < grid_.planned_.front() ? 0 : grid_.planned_.size() - 1};
  std::vector<double> next;
  for (;;) {
    // A curve's share is linear in how it follows the slowdown, so that curves of one middle and
    // width are one sum.
    std::vector<LinearInFollows> pairs;
    for (std::size_t i = 0; i < active.size(); ++i) {
      LinearInFollows& pair = pairs.emplace_back();
      for (std::size_t e = 0; e < ends.size(); ++e) {
        const float weight = weights[i * ends.size() + e];
        const float threshold = grid_.threshold_[active[i] * ends.size() + e];
        const auto floor = static_cast<float>(ends[e].floor);
        const auto span = static_cast<float>(1.0 - ends[e].floor - ends[e].lapses);
        pair.all += weight, pair.all_sum += weight * threshold;
        pair.floor += weight * floor, pair.floor_sum += weight * threshold * floor;
        pair.span += weight * span, pair.span_sum += weight * threshold * span;
      }
    }
    // The expected variance after a flight is E t² − Σ (E t; outcome)² / P(outcome) over both
    // outcomes: the sum is to be large.
    float best = -1.0F, best_share = 0.0F;
    std::size_t best_tried = 0;
    for (const std::size_t slowdown : tried) {
      const std::vector<float>& follows = grid_.follows_[slowdown];
      float all = 0.0F, all_sum = 0.0F, reached = 0.0F, sum = 0.0F;
      for (std::size_t i = 0; i < active.size(); ++i) {
        const LinearInFollows& pair = pairs[i];
        const float follows_here = follows[active[i]];
        all += pair.all;
        all_sum += pair.all_sum;
        reached += pair.floor + pair.span * follows_here;
        sum += pair.floor_sum + pair.span_sum * follows_here;
      }
      const float missed = all - reached, missed_sum = all_sum - sum;
      const float gain = (reached > 0.0F ? sum * sum / reached : 0.0F) +
                         (missed > 0.0F ? missed_sum * missed_sum / missed : 0.0F);
      if (gain > best) best = gain, best_tried = slowdown, best_share = reached / all;
    }
    next.push_back(grid_.planned_[best_tried]);
    if (next.size() >= count) return next;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      if (weights[i] < least) continue;
      const std::size_t pair = active[i / ends.size()];
      const auto& [lapses, floor, prior] = ends[i % ends.size()];
      const auto share = std::clamp(
          static_cast<float>(floor + (1.0 - floor - lapses) * grid_.follows_[best_tried][pair]),
          kLeastShare, 1.0F - kLeastShare);
      weights[i] *=
          std::exp(best_share * std::log(share) + (1.0F - best_share) * std::log(1.0F - share));
    }
  }
}

namespace {

constexpr std::size_t kDraws = 500;
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

// How much flights deviate from their expected share in the same direction as the flight before.
struct Alikeness {
  double before = 0.0, sum = 0.0;
  void add(bool reached, double share) {
    const double deviation = (reached ? 1.0 : 0.0) - share;
    sum += before * deviation;
    before = deviation;
  }
};

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
  std::vector<double> cumulative(joint_.size());
  std::inclusive_scan(joint_.begin(), joint_.end(), cumulative.begin(), std::plus<>(), 0.0);
  std::size_t as_far = 0, as_far_somewhere = 0, as_alike = 0;
  for (std::size_t draw_index = 0; draw_index < kDraws; ++draw_index) {
    const auto drawn = static_cast<std::size_t>(
        std::ranges::upper_bound(cumulative, random.uniform() * cumulative.back()) -
        cumulative.begin());
    const std::size_t block = drawn / kEnds;
    const CurveGrid::Curve& curve = grid_.curves_[block / scales_ * kEnds + drawn % kEnds];
    const double spread = kAllScales[block % scales_] * curve.width;
    double observed = 0.0, replicated = 0.0, observed_most = 0.0, replicated_most = 0.0;
    Alikeness alike, drawn_alike;
    for (const std::vector<Flight>& group : groups) {
      std::array<double, kMostKinds> expected{}, counts{}, replica{};
      for (const Flight& flight : group) {
        const auto kinds = kind_probabilities(
            (curve.middle - std::log(flight.slowdown)) / curve.width, spread, with_margins);
        double left = random.uniform(), share = 0.0;
        bool is_drawn = false, drawn_reached = false;
        for (std::size_t kind = 0; kind < kMostKinds; ++kind) {
          const auto& [lapses, floor, prior] = *curve.ends;
          const double probability = (1.0 - lapses - floor) * kinds[kind].curve +
                                     lapses * kinds[kind].lapse + floor * kinds[kind].floor;
          const bool is_reached = kinds[kind].lapse == 0.0;
          expected[kind] += probability;
          if (is_reached) share += probability;
          left -= probability;
          if (left >= 0.0 || is_drawn) continue;
          replica[kind] += 1.0;
          is_drawn = true;
          drawn_reached = is_reached;
        }
        counts[kind_of(flight, with_margins)] += 1.0;
        alike.add(flight.reached, share);
        drawn_alike.add(drawn_reached, share);
      }
      const double own = deviation(counts, expected), drawn_one = deviation(replica, expected);
      observed += own;
      replicated += drawn_one;
      observed_most = std::max(observed_most, own);
      replicated_most = std::max(replicated_most, drawn_one);
    }
    if (replicated >= observed) ++as_far;
    if (replicated_most >= observed_most) ++as_far_somewhere;
    if (drawn_alike.sum >= alike.sum) ++as_alike;
  }
  const auto least = static_cast<double>(std::min({as_far, as_far_somewhere, as_alike}));
  return std::min(1.0, 3.0 * least / static_cast<double>(kDraws));
}

}  // namespace tether::sizing
