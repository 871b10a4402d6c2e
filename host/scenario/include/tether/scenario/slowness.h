#pragma once

#include <optional>
#include <utility>

#include <tether/scenario/scenario.h>

namespace tether::scenario {

/// How many times as long a target computes as the computer of a condition.
struct Slowness {
  double factor = 1.0;
  std::optional<std::pair<double, double>> bounds{};  ///< none: not known
};

/// By the factors of their clocks. Of counted targets, by their costs: the bounds are the least and
/// the greatest ratio of the costs of one kind of work, so that they hold for every program.
/// @throws Error(kUsage) about the target's file, if the two cannot be compared.
Slowness slowness(const Target& target, const Condition& condition);

}  // namespace tether::scenario
