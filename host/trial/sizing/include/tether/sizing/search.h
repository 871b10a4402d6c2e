#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

/// The search of `tether size`, whatever varies: flights at ordered levels until there is an
/// answer.
namespace tether::sizing {

/// What varies, as levels: level 0 asks the least of the computer.
class Axis {
 public:
  virtual ~Axis() = default;
  /// The levels of the next flights, at most so many; none: there is an answer.
  /// @param most 0: no more flights can be flown, or more would show nothing new.
  virtual std::vector<std::size_t> next_levels(std::size_t most) = 0;
  /// What flights have shown so far, for the progress.
  virtual std::string so_far() const = 0;
};

/// A flight. Each has a seed of its own: flights with the same seed succeed and fail together, and
/// say less than their number.
struct Wanted {
  std::size_t level = 0;
  std::uint64_t seed = 1;

  friend bool operator==(const Wanted&, const Wanted&) = default;
};

/// What a flight turned out to be.
struct Flown {
  bool is_failed = false;    ///< which says nothing about the computer
  bool is_copy = false;      ///< of an earlier one at the same level
  bool lacks_value = false;  ///< missed a limit only because its metric has no value
};

/// Flies them. False: interrupted.
using FlyThem = std::function<bool(std::span<const Wanted>)>;
/// Gives a flight that has ended to the axis.
using TakeOne = std::function<Flown(const Wanted&)>;

/// With so many copies, the seeds change too little for an answer that is surer.
inline constexpr std::size_t kMostCopies = 20;

enum class SearchEnd {
  kAnswered,
  kInterrupted,
  kFailing,      ///< flight after flight failed
  kUndecidable,  ///< no flight has a value for the limit
};
/// Takes the earlier flights, in their order, then flies until there is an answer: at most so many
/// in all, and so many at once.
SearchEnd search(Axis& axis, std::uint64_t most, std::size_t at_once,
                 std::span<const Wanted> earlier, const FlyThem& fly, const TakeOne& take);

}  // namespace tether::sizing
