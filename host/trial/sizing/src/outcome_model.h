#pragma once

#include <array>
#include <cstddef>

#include <tether/sizing/sizing.h>

/// What a flight says about a curve, given one middle, width and scale of the margin.
namespace tether::sizing {

/// Beyond it, a margin only counts as such: metrics are linear in the log slowdown near their limit
/// at most.
inline constexpr double kFarMargin = 0.5;

/// The likelihood of a flight, as a part that follows the curve, one of flights that fail and one
/// of flights that succeed whatever the slowdown.
struct Likelihood {
  double curve = 0.0, lapse = 0.0, floor = 0.0;
};
/// @param z (middle − ln slowdown) / width; @param spread of the margin's noise
Likelihood likelihood(const Flight& flight, double z, double spread);

/// Kinds of outcomes, from missed to reached: without margins two, else by the margin's size.
inline constexpr std::size_t kMostKinds = 5;
std::size_t kind_of(const Flight& flight, bool with_margins);
/// The probability of each kind, as the three parts of a likelihood.
std::array<Likelihood, kMostKinds> kind_probabilities(double z, double spread, bool with_margins);

}  // namespace tether::sizing
