#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <tether/sizing/search.h>

/// The answer where no curve fits: level by level, without assuming how the share falls.
namespace tether::sizing {

/// A neighbourhood of slowdowns, and its flights.
struct Level {
  std::vector<double> slowdowns{};  ///< that may be flown, ascending, not empty
  std::size_t flights = 0;
  std::size_t reached = 0;
  Share share{};  ///< as exact_share; 0 to 1 without flights

  double middle() const { return slowdowns[slowdowns.size() / 2]; }
};

/// With the exact interval (Clopper & Pearson, Biometrika 26, 1934). @pre flights ≥ 1.
Share exact_share(std::size_t reached, std::size_t flights, double confidence);

/// All slowdowns of the question, in ascending order. A level is so wide that an interval that is
/// narrow enough spans two and a half of them.
std::vector<Level> levels_of(const Question& question, std::span<const Flight> flights,
                             double confidence);

struct LevelAnswer {
  /// The slowdown up to which each level is sufficient: the interval is from the largest level
  /// below the first insufficient one that is sufficient itself (its middle), to the end of that
  /// first one. A level is sufficient if its whole interval is at or above the wanted share, and
  /// insufficient if all of it is below. 0 and infinity: there is no such level.
  Threshold threshold{};
  Level next{};          ///< the level to fly next
  bool is_done = false;  ///< narrow enough, or no level between the bounds is worth more flights
};
LevelAnswer answer_by_levels(const Question& question, std::span<const Flight> flights);

}  // namespace tether::sizing
