#include "two_sample.h"

#include <algorithm>
#include <cmath>

namespace tether::system_test {
namespace {

/// The largest distance between the two empirical distribution functions. @pre sorted
double largest_distance(const std::vector<double>& a, const std::vector<double>& b) {
  double distance = 0.0;
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size() && j < b.size()) {
    const double value = std::min(a[i], b[j]);
    while (i < a.size() && a[i] <= value) ++i;
    while (j < b.size() && b[j] <= value) ++j;
    const double share_a = static_cast<double>(i) / static_cast<double>(a.size());
    const double share_b = static_cast<double>(j) / static_cast<double>(b.size());
    distance = std::max(distance, std::abs(share_a - share_b));
  }
  return distance;
}

double kolmogorov_tail(double lambda) {
  double sum = 0.0;
  for (int k = 1; k <= 100; ++k)
    sum += (k % 2 == 1 ? 2.0 : -2.0) * std::exp(-2.0 * k * k * lambda * lambda);
  return lambda < 0.2 ? 1.0 : std::clamp(sum, 0.0, 1.0);
}

}  // namespace

double kolmogorov_smirnov_p(std::vector<double> a, std::vector<double> b) {
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  const auto n = static_cast<double>(a.size());
  const auto m = static_cast<double>(b.size());
  const double effective = std::sqrt(n * m / (n + m));
  return kolmogorov_tail((effective + 0.12 + 0.11 / effective) * largest_distance(a, b));
}

}  // namespace tether::system_test
