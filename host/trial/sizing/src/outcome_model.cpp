#include "outcome_model.h"

#include <cmath>

namespace tether::sizing {
namespace {

double logistic(double z) {
  return 1.0 / (1.0 + std::exp(-z));
}

double logistic_density(double z) {
  const double e = std::exp(-std::abs(z));
  return e / ((1.0 + e) * (1.0 + e));
}

}  // namespace

Likelihood likelihood(const Flight& flight, double z, double spread) {
  const bool reached = flight.reached;
  if (!flight.margin) return {logistic(reached ? z : -z), reached ? 0.0 : 1.0, reached ? 1.0 : 0.0};
  // Half of the flights that do not follow the curve end far from the limit, half anywhere near it.
  const double margin = *flight.margin;
  const bool is_far = std::abs(margin) >= kFarMargin;
  const double other = is_far ? 0.5 : 0.5 / kFarMargin;
  Likelihood parts{0.0, reached ? 0.0 : other, reached ? other : 0.0};
  if (is_far)
    parts.curve = logistic((reached ? z : -z) - kFarMargin / spread);
  else
    parts.curve = logistic_density(margin / spread - z) / spread;
  return parts;
}

std::size_t kind_of(const Flight& flight, bool with_margins) {
  if (!with_margins) return flight.reached ? 1 : 0;
  if (!flight.margin) return flight.reached ? 4 : 0;
  if (std::abs(*flight.margin) >= kFarMargin) return flight.reached ? 4 : 0;
  if (!flight.reached) return 1;
  return *flight.margin < kFarMargin / 2.0 ? 2 : 3;
}

std::array<Likelihood, kMostKinds> kind_probabilities(double z, double spread, bool with_margins) {
  if (!with_margins) return {{{logistic(-z), 1.0, 0.0}, {logistic(z), 0.0, 1.0}}};
  const auto below = [&](double margin) { return logistic(margin / spread - z); };
  const double far_missed = below(-kFarMargin), missed = below(0.0);
  const double half = below(kFarMargin / 2.0), near = below(kFarMargin);
  return {{{far_missed, 0.5, 0.0},
           {missed - far_missed, 0.5, 0.0},
           {half - missed, 0.0, 0.25},
           {near - half, 0.0, 0.25},
           {1.0 - near, 0.0, 0.5}}};
}

}  // namespace tether::sizing
