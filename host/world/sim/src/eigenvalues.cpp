#include "eigenvalues.h"

#include <cmath>
#include <limits>

namespace tether::sim {
namespace {

using Complex = std::complex<double>;

/// The rotation of two rows that makes the second of two numbers in them 0.
struct Rotation {
  std::size_t row, other;
  Complex c{1.0}, s{0.0};

  Rotation(const Matrix& a, std::size_t upper, std::size_t lower, std::size_t column)
      : row(upper), other(lower) {
    const Complex p = a[row][column], q = a[other][column];
    const double length = std::hypot(std::abs(p), std::abs(q));
    if (length == 0.0) return;
    c = std::conj(p) / length;
    s = std::conj(q) / length;
  }

  void turn_rows(Matrix& a, std::size_t begin, std::size_t end) const {
    for (std::size_t k = begin; k < end; ++k) {
      const Complex upper = a[row][k], lower = a[other][k];
      a[row][k] = c * upper + s * lower;
      a[other][k] = std::conj(c) * lower - std::conj(s) * upper;
    }
  }
  /// By the inverse.
  void turn_columns(Matrix& a, std::size_t begin, std::size_t end) const {
    for (std::size_t k = begin; k < end; ++k) {
      const Complex left = a[k][row], right = a[k][other];
      a[k][row] = left * std::conj(c) + right * std::conj(s);
      a[k][other] = right * c - left * s;
    }
  }
};

/// A similar matrix with zeros below its first subdiagonal.
void make_hessenberg(Matrix& a) {
  for (std::size_t j = 0; j + 2 < a.size(); ++j) {
    for (std::size_t i = j + 2; i < a.size(); ++i) {
      const Rotation rotation(a, j + 1, i, j);
      rotation.turn_rows(a, 0, a.size());
      rotation.turn_columns(a, 0, a.size());
    }
  }
}

bool is_negligible(const Matrix& a, std::size_t row) {
  const double beside = std::abs(a[row][row]) + std::abs(a[row - 1][row - 1]);
  return std::abs(a[row][row - 1]) <= std::numeric_limits<double>::epsilon() * beside;
}

/// The eigenvalue of the block's last 2 × 2 block that is nearer to its corner.
Complex shift_of(const Matrix& a, std::size_t end) {
  const Complex p = a[end - 2][end - 2], q = a[end - 2][end - 1];
  const Complex r = a[end - 1][end - 2], s = a[end - 1][end - 1];
  const Complex half = 0.5 * (p + s);
  const Complex root = std::sqrt(half * half - (p * s - q * r));
  return std::abs(half + root - s) < std::abs(half - root - s) ? half + root : half - root;
}

/// Of the block [begin, end): A − shift = Q R becomes R Q + shift.
void step(Matrix& a, std::size_t begin, std::size_t end, Complex shift) {
  std::vector<Rotation> rotations;
  for (std::size_t i = begin; i < end; ++i) a[i][i] -= shift;
  for (std::size_t i = begin; i + 1 < end; ++i)
    rotations.emplace_back(a, i, i + 1, i).turn_rows(a, i, end);
  for (const Rotation& rotation : rotations) rotation.turn_columns(a, begin, rotation.other + 1);
  for (std::size_t i = begin; i < end; ++i) a[i][i] += shift;
}

}  // namespace

std::vector<Complex> eigenvalues(Matrix a) {
  constexpr int kPatience = 12;  // after so many steps, another shift than the best one
  make_hessenberg(a);
  std::vector<Complex> values;
  int steps = 0;
  for (std::size_t end = a.size(); end > 0;) {
    std::size_t begin = end - 1;
    while (begin > 0 && !is_negligible(a, begin)) --begin;
    if (begin + 1 == end || steps > 100 * kPatience) {
      const bool is_found = begin + 1 == end;
      values.push_back(is_found ? a[end - 1][end - 1]
                                : Complex(std::numeric_limits<double>::infinity()));
      --end;
      steps = 0;
      continue;
    }
    const bool is_stuck = ++steps % kPatience == 0;
    step(a, begin, end,
         is_stuck ? a[end - 1][end - 1] + std::abs(a[end - 1][end - 2]) : shift_of(a, end));
  }
  return values;
}

}  // namespace tether::sim
