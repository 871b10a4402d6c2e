#pragma once

#include <optional>
#include <utility>

#include <tether/scenario/scenario.h>

namespace tether::scenario {

/// How many times as long a target computes as the computer of a condition of the scenario.
struct Slowness {
  double factor = 1.0;
  std::optional<std::pair<double, double>> bounds{};  ///< none: not known
};

/// By the factors of their clocks. Of counted targets, by their costs: the bounds are the least and
/// the greatest ratio of the costs of one kind of work, so that they hold for every program.
/// @throws Error(kUsage) about the target's file, if the two cannot be compared, or differ in more
/// than in speed: in their launcher or, where energy is simulated, in their power.
Slowness slowness(const Target& target, const Scenario& scenario, const Condition& condition);

}  // namespace tether::scenario
