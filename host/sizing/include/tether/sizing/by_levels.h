#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <tether/sizing/question.h>

/// The answer where no curve fits: level by level, without assuming how the share falls.
namespace tether::sizing {

/// The flights at one slowdown.
struct Level {
  double slowdown = 1.0;
  std::size_t flights = 0;
  std::size_t reached = 0;
  Share share{};  ///< with Wilson's interval (JASA 22, 1927)
};

/// @pre flights ≥ 1.
Share wilson(std::size_t reached, std::size_t flights, double confidence);

/// Every slowdown that was flown, in ascending order.
std::vector<Level> levels_of(std::span<const Flight> flights, double confidence);

struct LevelAnswer {
  /// The slowdown up to which each level is sufficient: the interval is from the largest level
  /// below the first insufficient one that is sufficient itself, to that first one. A level is
  /// sufficient if its whole interval is at or above the wanted share, and insufficient if all of
  /// it is below. 0 and infinity: there is no such level.
  Threshold threshold{};
  std::size_t next = 0;  ///< index of the level to fly next
  bool is_done = false;  ///< narrow enough, or no level between the bounds is worth more flights
};
/// @param levels that may be flown, ascending.
LevelAnswer answer_by_levels(const Question& question, std::span<const double> levels,
                             std::span<const Flight> flights);

}  // namespace tether::sizing
