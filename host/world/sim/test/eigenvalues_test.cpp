#include "eigenvalues.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <tether/base/random.h>

namespace tether::sim {
namespace {

using Complex = std::complex<double>;

std::vector<Complex> sorted(std::vector<Complex> values) {
  std::ranges::sort(
      values, {}, [](const Complex& v) { return std::pair(std::round(1e6 * v.real()), v.imag()); });
  return values;
}

void expect_near(const std::vector<Complex>& values, const std::vector<Complex>& expected) {
  ASSERT_EQ(values.size(), expected.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    EXPECT_LT(std::abs(values[i] - expected[i]), 1e-6) << i << ": " << values[i];
}

TEST(Eigenvalues, AreThoseOfKnownMatrices) {
  EXPECT_TRUE(eigenvalues({}).empty());
  expect_near(eigenvalues({{7.0}}), {7.0});
  expect_near(sorted(eigenvalues({{0, 1}, {-1, 0}})), {{0, -1}, {0, 1}});
  expect_near(eigenvalues(Matrix(4, std::vector<Complex>(4))), {0.0, 0.0, 0.0, 0.0});
  // A ring: the roots of 1.
  expect_near(sorted(eigenvalues({{0, 0, 0, 1}, {1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}})),
              {-1.0, {0, -1}, {0, 1}, 1.0});
  // The companion of (x − 1) (x − 2) (x − 3) (x² + 1).
  expect_near(sorted(eigenvalues({{6, -12, 12, -11, 6},
                                  {1, 0, 0, 0, 0},
                                  {0, 1, 0, 0, 0},
                                  {0, 0, 1, 0, 0},
                                  {0, 0, 0, 1, 0}})),
              {{0, -1}, {0, 1}, 1.0, 2.0, 3.0});
}

TEST(Eigenvalues, OfRandomMatricesHaveTheTraceAndTheSizeOfTheMatrix) {
  KeyedRandom random({1, random_stream("eigenvalues", "", ""), 0});
  for (std::size_t size = 1; size <= 24; ++size) {
    Matrix a(size, std::vector<Complex>(size));
    Complex trace = 0.0;
    for (auto& row : a)
      for (Complex& number : row) number = 2.0 * random.uniform() - 1.0;
    for (std::size_t i = 0; i < size; ++i) trace += a[i][i];
    Complex sum = 0.0;
    const auto values = eigenvalues(a);
    for (const Complex& value : values) sum += value;
    EXPECT_EQ(values.size(), size);
    EXPECT_LT(std::abs(sum - trace), 1e-9) << size;
  }
}

TEST(Eigenvalues, EndForNumbersThatAreNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Complex& value : eigenvalues({{nan, 1, 2}, {3, 4, 5}, {6, 7, 8}}))
    EXPECT_FALSE(std::isfinite(std::abs(value)));
}

}  // namespace
}  // namespace tether::sim
