#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include <boost/math/distributions/hypergeometric.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>

#include <tether/campaign/campaign_results.h>

// Means with Student's and Welch's intervals, the Mann-Whitney test, exact for small samples, and
// Fisher's.
namespace tether::campaign {
namespace {

constexpr double kConfidence = 0.95;

double mean_of(std::span<const double> values) {
  const double sum = std::accumulate(values.begin(), values.end(), 0.0);
  const double mean = sum / static_cast<double>(values.size());
  // A second pass takes out what rounding lost in the first.
  double rest = 0.0;
  for (const double value : values) rest += value - mean;
  return mean + rest / static_cast<double>(values.size());
}

double variance_of(std::span<const double> values, double mean) {
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return squares / static_cast<double>(values.size() - 1);
}

double median_of(std::span<const double> values) {
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  const std::size_t middle = sorted.size() / 2;
  return sorted.size() % 2 == 1 ? sorted[middle] : (sorted[middle - 1] + sorted[middle]) / 2.0;
}

Interval around(double centre, double standard_error, double degrees_of_freedom) {
  if (standard_error == 0.0) return {centre, centre};
  const boost::math::students_t t(degrees_of_freedom);
  const double reach = boost::math::quantile(t, 0.5 + kConfidence / 2.0) * standard_error;
  return {centre - reach, centre + reach};
}

// Ranks of the pooled values, doubled so that the mid-ranks of ties are whole. Those of `a` come
// first.
struct PooledRanks {
  std::vector<std::size_t> doubled;
  double tie_term = 0.0;  // Σ (t³ − t) over groups of t tied values
};

PooledRanks pooled_ranks(std::span<const double> a, std::span<const double> b) {
  std::vector<double> values(a.begin(), a.end());
  values.insert(values.end(), b.begin(), b.end());
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t i, std::size_t j) { return values[i] < values[j]; });
  PooledRanks ranks;
  ranks.doubled.resize(values.size());
  for (std::size_t first = 0, end = 0; first < order.size(); first = end) {
    while (end < order.size() && values[order[end]] == values[order[first]]) ++end;
    // Ranks first+1 … end share their mean.
    for (std::size_t i = first; i < end; ++i) ranks.doubled[order[i]] = first + 1 + end;
    const double tied = static_cast<double>(end - first);
    ranks.tie_term += tied * tied * tied - tied;
  }
  return ranks;
}

// How many choices of `count` of the ranks have each sum: index = sum of doubled ranks.
std::vector<double> rank_sum_counts(const std::vector<std::size_t>& doubled, std::size_t count) {
  const std::size_t largest = std::accumulate(doubled.begin(), doubled.end(), std::size_t{0});
  std::vector<std::vector<double>> ways(count + 1, std::vector<double>(largest + 1, 0.0));
  ways[0][0] = 1.0;
  for (const std::size_t rank : doubled) {
    for (std::size_t chosen = count; chosen > 0; --chosen) {
      for (std::size_t sum = largest; sum >= rank; --sum) {
        ways[chosen][sum] += ways[chosen - 1][sum - rank];
      }
    }
  }
  return ways[count];
}

double exact_p(const PooledRanks& ranks, std::size_t count, std::size_t observed) {
  const std::vector<double> ways = rank_sum_counts(ranks.doubled, count);
  double below = 0.0, above = 0.0, all = 0.0;
  for (std::size_t sum = 0; sum < ways.size(); ++sum) {
    all += ways[sum];
    if (sum <= observed) below += ways[sum];
    if (sum >= observed) above += ways[sum];
  }
  return std::min(1.0, 2.0 * std::min(below, above) / all);
}

double approximate_p(const PooledRanks& ranks, double u, double n_a, double n_b) {
  const double n = n_a + n_b;
  const double variance = n_a * n_b / 12.0 * (n + 1.0 - ranks.tie_term / (n * (n - 1.0)));
  if (variance <= 0.0) return 1.0;
  const double distance = std::max(0.0, std::abs(u - n_a * n_b / 2.0) - 0.5);
  const boost::math::normal normal;
  return 2.0 * boost::math::cdf(boost::math::complement(normal, distance / std::sqrt(variance)));
}

}  // namespace

Summary summarise(std::span<const double> values) {
  Summary summary;
  summary.n = values.size();
  if (values.empty()) return summary;
  const auto [min, max] = std::minmax_element(values.begin(), values.end());
  summary.min = *min;
  summary.max = *max;
  summary.mean = mean_of(values);
  summary.median = median_of(values);
  if (values.size() < 2) return summary;
  const double n = static_cast<double>(values.size());
  summary.stddev = std::sqrt(variance_of(values, summary.mean));
  summary.ci95 = around(summary.mean, *summary.stddev / std::sqrt(n), n - 1.0);
  return summary;
}

MeanDifference compare_means(std::span<const double> a, std::span<const double> b) {
  const double mean_a = mean_of(a), mean_b = mean_of(b);
  MeanDifference result;
  result.difference = mean_a - mean_b;
  if (a.size() < 2 || b.size() < 2) return result;
  const double n_a = static_cast<double>(a.size()), n_b = static_cast<double>(b.size());
  const double error_a = variance_of(a, mean_a) / n_a, error_b = variance_of(b, mean_b) / n_b;
  const double error = error_a + error_b;
  if (error > 0.0) {
    result.degrees_of_freedom =
        error * error / (error_a * error_a / (n_a - 1.0) + error_b * error_b / (n_b - 1.0));
  }
  result.ci95 = around(result.difference, std::sqrt(error), result.degrees_of_freedom);
  return result;
}

RankTest mann_whitney(std::span<const double> a, std::span<const double> b) {
  constexpr std::size_t kMostForExact = 100;
  const PooledRanks ranks = pooled_ranks(a, b);
  const auto end_of_a = ranks.doubled.begin() + static_cast<std::ptrdiff_t>(a.size());
  const std::size_t doubled_sum = std::accumulate(ranks.doubled.begin(), end_of_a, std::size_t{0});
  const double n_a = static_cast<double>(a.size()), n_b = static_cast<double>(b.size());
  RankTest test;
  test.u = static_cast<double>(doubled_sum) / 2.0 - n_a * (n_a + 1.0) / 2.0;
  test.exact = a.size() + b.size() <= kMostForExact;
  test.p_two_sided =
      test.exact ? exact_p(ranks, a.size(), doubled_sum) : approximate_p(ranks, test.u, n_a, n_b);
  return test;
}

double fisher_exact(const Count& a, const Count& b) {
  if (a.all == 0 || b.all == 0) return 1.0;
  constexpr double kEqual = 1.0 + 1e-7;  // two splits, but for rounding
  const std::size_t of_them = a.of_them + b.of_them;
  const boost::math::hypergeometric splits(static_cast<unsigned>(of_them),
                                           static_cast<unsigned>(a.all),
                                           static_cast<unsigned>(a.all + b.all));
  const double observed = boost::math::pdf(splits, static_cast<unsigned>(a.of_them));
  const std::size_t least = of_them > b.all ? of_them - b.all : 0;
  double p = 0.0;
  for (std::size_t of_a = least; of_a <= std::min(of_them, a.all); ++of_a) {
    const double likelihood = boost::math::pdf(splits, static_cast<unsigned>(of_a));
    if (likelihood <= observed * kEqual) p += likelihood;
  }
  return std::min(p, 1.0);
}

std::vector<double> holm(std::span<const double> p_values) {
  std::vector<std::size_t> order(p_values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return p_values[i]; });
  std::vector<double> corrected(p_values.size());
  double least = 0.0;
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    const double times = static_cast<double>(order.size() - rank);
    least = std::max(least, std::min(1.0, times * p_values[order[rank]]));
    corrected[order[rank]] = least;
  }
  return corrected;
}

}  // namespace tether::campaign
