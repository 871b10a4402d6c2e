// Expected values come from outside this code; each test names its source.
#include <bit>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <tether/base/random.h>
#include <tether/campaign/campaign_results.h>

namespace tether::campaign {
namespace {

// Student (1908), "The probable error of a mean": extra hours of sleep under two drugs; R's data
// set `sleep`, on whose help page the results of t.test stand.
const std::vector<double> kSleep1 = {0.7, -1.6, -0.2, -1.2, -0.1, 3.4, 3.7, 0.8, 0.0, 2.0};
const std::vector<double> kSleep2 = {1.9, 0.8, 1.1, 0.1, -0.1, 4.4, 5.5, 1.6, 4.6, 3.4};

// Student gives means 0.75 and 2.33; R: sd 1.789010 and 2.002249, 95 % interval of the first mean
// from -0.5297804 to 2.0297804.
TEST(Summarise, StudentsSleepData) {
  const Summary first = summarise(kSleep1);
  EXPECT_EQ(first.n, 10u);
  EXPECT_NEAR(first.mean, 0.75, 1e-12);
  EXPECT_NEAR(*first.stddev, 1.789010, 5e-7);
  EXPECT_NEAR(first.median, 0.35, 1e-12);
  EXPECT_EQ(first.min, -1.6);
  EXPECT_EQ(first.max, 3.7);
  EXPECT_NEAR(first.ci95->low, -0.5297804, 5e-8);
  EXPECT_NEAR(first.ci95->high, 2.0297804, 5e-8);
  const Summary second = summarise(kSleep2);
  EXPECT_NEAR(second.mean, 2.33, 1e-12);
  EXPECT_NEAR(*second.stddev, 2.002249, 5e-7);
}

// Henderson and Velleman (1981): miles per gallon of 32 cars, with automatic and manual gears; R's
// data set `mtcars`.
const std::vector<double> kAutomatic = {21.4, 18.7, 18.1, 14.3, 24.4, 22.8, 19.2, 17.8, 16.4, 17.3,
                                        15.2, 10.4, 10.4, 14.7, 21.5, 15.5, 15.2, 13.3, 19.2};
const std::vector<double> kManual = {21.0, 21.0, 22.8, 32.4, 30.4, 33.9, 27.3,
                                     26.0, 30.4, 15.8, 19.7, 15.0, 21.4};

// R, summary(mtcars$mpg[mtcars$am == 0]): median 17.30, mean 17.15.
TEST(Summarise, MedianOfAnOddNumberOfCars) {
  EXPECT_NEAR(summarise(kAutomatic).median, 17.30, 1e-12);
  EXPECT_NEAR(summarise(kAutomatic).mean, 17.15, 5e-3);
}

// NIST Statistical Reference Datasets, NumAcc1 and NumAcc2: certified means and deviations.
TEST(Summarise, NistNumericalAccuracy) {
  const Summary first = summarise(std::vector<double>{10000001, 10000003, 10000002});
  EXPECT_EQ(first.mean, 10000002.0);
  EXPECT_EQ(*first.stddev, 1.0);
  std::vector<double> values = {1.2};
  for (int i = 0; i < 500; ++i) values.insert(values.end(), {1.1, 1.3});
  const Summary second = summarise(values);
  EXPECT_NEAR(second.mean, 1.2, 1e-14);
  EXPECT_NEAR(*second.stddev, 0.1, 1e-14);
}

TEST(Summarise, OfFewValues) {
  EXPECT_EQ(summarise({}).n, 0u);
  const Summary one = summarise(std::vector<double>{2.5});
  EXPECT_EQ(one.mean, 2.5);
  EXPECT_EQ(one.median, 2.5);
  EXPECT_FALSE(one.stddev);
  EXPECT_FALSE(one.ci95);
  const Summary same = summarise(std::vector<double>{0.0, 0.0, 0.0});
  EXPECT_EQ(same.stddev, 0.0);
  EXPECT_EQ(same.ci95, (Interval{0.0, 0.0}));
}

// R, help page of t.test: t.test(extra ~ group, data = sleep) gives df = 17.776 and the interval
// from -3.3654832 to 0.2054832.
TEST(CompareMeans, WelchOnStudentsSleepData) {
  const MeanDifference result = compare_means(kSleep1, kSleep2);
  EXPECT_NEAR(result.difference, -1.58, 1e-12);
  EXPECT_NEAR(result.degrees_of_freedom, 17.776, 5e-4);
  EXPECT_NEAR(result.ci95->low, -3.3654832, 5e-8);
  EXPECT_NEAR(result.ci95->high, 0.2054832, 5e-8);
}

// R, t.test(mpg ~ am, data = mtcars): means 17.14737 and 24.39231, df = 18.332, interval from
// -11.280194 to -3.209684; of other sizes and spreads than the above.
TEST(CompareMeans, WelchOnMileages) {
  const MeanDifference result = compare_means(kAutomatic, kManual);
  EXPECT_NEAR(result.difference, 17.14737 - 24.39231, 1e-5);
  EXPECT_NEAR(result.degrees_of_freedom, 18.332, 5e-4);
  EXPECT_NEAR(result.ci95->low, -11.280194, 5e-7);
  EXPECT_NEAR(result.ci95->high, -3.209684, 5e-7);
}

TEST(CompareMeans, WithoutSpread) {
  const std::vector<double> a = {2.0, 2.0}, b = {0.5, 0.5, 0.5}, one = {1.0};
  EXPECT_EQ(compare_means(a, b).ci95, (Interval{1.5, 1.5}));
  EXPECT_EQ(compare_means(a, one).difference, 1.0);
  EXPECT_FALSE(compare_means(a, one).ci95);
}

// Hollander & Wolfe (1973), p. 69 f., as on R's help page of wilcox.test: W = 35, one-sided
// p = 0.1272.
TEST(MannWhitney, HollanderWolfePermeability) {
  const std::vector<double> x = {0.80, 0.83, 1.89, 1.04, 1.45, 1.38, 1.91, 1.64, 0.73, 1.46};
  const std::vector<double> y = {1.15, 0.88, 0.90, 0.74, 1.21};
  const RankTest test = mann_whitney(x, y);
  EXPECT_EQ(test.u, 35.0);
  EXPECT_TRUE(test.exact);
  EXPECT_NEAR(test.p_two_sided, 2 * 0.1272, 1e-4);
}

// Critical values of U at two-sided 5 % (Mann & Whitney's tables, as in any textbook): 23 for
// n = 10, 10; 2 for 5, 5. One more is no longer significant.
std::vector<double> sample_with_u(std::size_t n, std::size_t u, std::vector<double>& other) {
  // `other` is 1 … n; u of the pairs are in favour of the returned sample.
  std::vector<double> values;
  other.clear();
  for (std::size_t i = 1; i <= n; ++i) other.push_back(static_cast<double>(i));
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t wins = std::min(u, n);
    u -= wins;
    values.push_back(static_cast<double>(wins) + 0.5 + 0.001 * static_cast<double>(i));
  }
  return values;
}

TEST(MannWhitney, TabulatedCriticalValues) {
  struct Row {
    std::size_t n, critical_u;
  };
  for (const Row row : {Row{5, 2}, Row{8, 13}, Row{10, 23}, Row{20, 127}}) {
    std::vector<double> other;
    const auto at = sample_with_u(row.n, row.critical_u, other);
    EXPECT_EQ(mann_whitney(at, other).u, static_cast<double>(row.critical_u));
    EXPECT_LE(mann_whitney(at, other).p_two_sided, 0.05) << row.n;
    const auto beyond = sample_with_u(row.n, row.critical_u + 1, other);
    EXPECT_GT(mann_whitney(beyond, other).p_two_sided, 0.05) << row.n;
  }
}

// Ties: every split of the pooled values enumerated, by the definition of a permutation test.
double enumerated_p(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> pool = a;
  pool.insert(pool.end(), b.begin(), b.end());
  const auto u_of = [&](std::uint32_t chosen) {
    double u = 0.0;
    for (std::size_t i = 0; i < pool.size(); ++i) {
      for (std::size_t j = 0; j < pool.size(); ++j) {
        if (!(chosen >> i & 1u) || (chosen >> j & 1u)) continue;
        u += pool[i] > pool[j] ? 1.0 : (pool[i] == pool[j] ? 0.5 : 0.0);
      }
    }
    return u;
  };
  const double observed = u_of((1u << a.size()) - 1u);
  double below = 0, above = 0, all = 0;
  for (std::uint32_t chosen = 0; chosen < 1u << pool.size(); ++chosen) {
    if (static_cast<std::size_t>(std::popcount(chosen)) != a.size()) continue;
    const double u = u_of(chosen);
    ++all;
    if (u <= observed) ++below;
    if (u >= observed) ++above;
  }
  return std::min(1.0, 2.0 * std::min(below, above) / all);
}

TEST(MannWhitney, WithTiesAgreesWithEnumeration) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    KeyedRandom random({seed, 7, 0});
    std::vector<double> a, b;
    for (int i = 0; i < 5; ++i) a.push_back(std::floor(4.0 * random.uniform()));
    for (int i = 0; i < 6; ++i)
      b.push_back(std::floor(4.0 * random.uniform()) + 0.5 * static_cast<double>(seed % 3));
    EXPECT_NEAR(mann_whitney(a, b).p_two_sided, enumerated_p(a, b), 1e-12) << seed;
  }
}

TEST(MannWhitney, IsSymmetricAndFindsNothingInEqualValues) {
  const RankTest ab = mann_whitney(kSleep1, kSleep2), ba = mann_whitney(kSleep2, kSleep1);
  EXPECT_EQ(ab.p_two_sided, ba.p_two_sided);
  EXPECT_EQ(ab.u + ba.u, 100.0);
  for (const std::size_t n : {10u, 80u}) {
    const std::vector<double> zeros(n, 0.0);
    EXPECT_EQ(mann_whitney(zeros, zeros).p_two_sided, 1.0);
  }
}

// Where both are defined, the approximation for large samples is near the exact value.
TEST(MannWhitney, ApproximatesLargeSamples) {
  std::vector<double> a, b;
  for (int i = 0; i < 50; ++i) a.push_back(1.0 * i), b.push_back(1.0 * i + 10.5);
  const RankTest exact = mann_whitney(a, b);
  a.push_back(25.25);
  const RankTest approximate = mann_whitney(a, b);
  EXPECT_TRUE(exact.exact);
  EXPECT_FALSE(approximate.exact);
  EXPECT_NEAR(approximate.p_two_sided, exact.p_two_sided, 0.2 * exact.p_two_sided);
}

// The sums of the probabilities of all splits, computed with whole binomials.
TEST(FisherExact, SumsTheSplitsThatAreNoMoreLikely) {
  EXPECT_NEAR(fisher_exact({0, 4}, {4, 4}), 0.02857143, 1e-8);
  EXPECT_NEAR(fisher_exact({3, 10}, {9, 10}), 0.01976661, 1e-8);
  EXPECT_NEAR(fisher_exact({1, 12}, {5, 7}), 0.009545924, 1e-8);
  EXPECT_NEAR(fisher_exact({7, 10}, {7, 10}), 1.0, 1e-8);
  EXPECT_EQ(fisher_exact({0, 0}, {5, 7}), 1.0);
  EXPECT_LT(fisher_exact({0, 500}, {500, 500}), 1e-100);
}

TEST(Holm, MultipliesTheLeastByAllAndKeepsTheOrder) {
  EXPECT_EQ(holm(std::vector{0.01, 0.04, 0.03}), (std::vector{0.03, 0.06, 0.06}));
  EXPECT_EQ(holm(std::vector{0.5, 0.9}), (std::vector{1.0, 1.0}));
  EXPECT_TRUE(holm({}).empty());
}

}  // namespace
}  // namespace tether::campaign
