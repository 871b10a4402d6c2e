#include "cost_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace tether::calibration {
namespace {

using Shares = std::array<double, kWorkClasses>;

/// The normal equations of the relative errors, with the costs above their floor as unknowns:
/// minimise Σ (row · (floor + x) − 1)².
struct Normal {
  Costs_ns floor{};
  std::array<Shares, kWorkClasses> matrix{};
  Shares right{};
  double squares = 0.0;  // of what is left of the times above the floor

  void add(const CountedBlock& block) {
    Shares row{};
    for (std::size_t k = 0; k < kWorkClasses; ++k) row[k] = block.work[k] / block.time_ns;
    const double left = -relative_error(floor, block);
    for (std::size_t i = 0; i < kWorkClasses; ++i) {
      right[i] += block.weight * row[i] * left;
      for (std::size_t k = 0; k < kWorkClasses; ++k) matrix[i][k] += block.weight * row[i] * row[k];
    }
    squares += block.weight * left * left;
  }
};

/// Cholesky factorisation of the rows and columns of `kinds`; none if they are not independent.
std::optional<std::vector<double>> solve(const Normal& normal,
                                         const std::vector<std::size_t>& kinds) {
  constexpr double kLeastPivot = 1e-9;  // as a share of the diagonal
  const std::size_t n = kinds.size();
  std::vector<std::vector<double>> lower(n, std::vector<double>(n, 0.0));
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k <= i; ++k) {
      double sum = normal.matrix[kinds[i]][kinds[k]];
      for (std::size_t j = 0; j < k; ++j) sum -= lower[i][j] * lower[k][j];
      if (i != k) {
        lower[i][k] = sum / lower[k][k];
      } else if (sum <= kLeastPivot * normal.matrix[kinds[i]][kinds[i]]) {
        return std::nullopt;
      } else {
        lower[i][i] = std::sqrt(sum);
      }
    }
  }
  std::vector<double> x(n);
  for (std::size_t i = 0; i < n; ++i) {
    x[i] = normal.right[kinds[i]];
    for (std::size_t k = 0; k < i; ++k) x[i] -= lower[i][k] * x[k];
    x[i] /= lower[i][i];
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = i + 1; k < n; ++k) x[i] -= lower[k][i] * x[k];
    x[i] /= lower[i][i];
  }
  return x;
}

/// Sum of squared relative errors of a least-squares solution.
double residual(const Normal& normal, const std::vector<std::size_t>& kinds,
                const std::vector<double>& x) {
  double sum = normal.squares;
  for (std::size_t i = 0; i < kinds.size(); ++i) sum -= x[i] * normal.right[kinds[i]];
  return sum;
}

}  // namespace

double predicted_ns(const Costs_ns& costs, const CountedBlock& block) {
  double sum = 0.0;
  for (std::size_t k = 0; k < kWorkClasses; ++k) sum += costs[k] * block.work[k];
  return sum;
}

double relative_error(const Costs_ns& costs, const CountedBlock& block) {
  return predicted_ns(costs, block) / block.time_ns - 1.0;
}

Costs_ns fit_costs(const std::vector<CountedBlock>& blocks, const Costs_ns& floor_ns) {
  Normal normal{.floor = floor_ns};
  for (const CountedBlock& block : blocks) normal.add(block);
  Costs_ns best{};
  double least = std::numeric_limits<double>::infinity();
  for (unsigned set = 0; set < 1u << kWorkClasses; ++set) {
    std::vector<std::size_t> kinds;
    for (std::size_t k = 0; k < kWorkClasses; ++k)
      if ((set >> k & 1u) != 0) kinds.push_back(k);
    const auto x = solve(normal, kinds);
    if (!x || std::any_of(x->begin(), x->end(), [](double cost) { return cost < 0.0; })) continue;
    const double sum = residual(normal, kinds, *x);
    if (sum >= least) continue;
    least = sum;
    best = floor_ns;
    for (std::size_t i = 0; i < kinds.size(); ++i) best[kinds[i]] += (*x)[i];
  }
  return best;
}

std::vector<double> errors_when_left_out(const std::vector<CountedBlock>& blocks,
                                         const Costs_ns& floor_ns) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    std::vector<CountedBlock> others = blocks;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    errors.push_back(relative_error(fit_costs(others, floor_ns), blocks[i]));
  }
  return errors;
}

}  // namespace tether::calibration
