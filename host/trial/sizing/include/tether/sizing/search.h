#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
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
  /// Roughly how many flights are still needed, if that can be told.
  virtual std::optional<std::size_t> flights_left() const { return std::nullopt; }
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
  kInterrupted,  ///< the axis has the answer of the flights so far
  kFailing,      ///< flight after flight failed
  kUndecidable,  ///< no flight has a value for the limit
};
/// Takes the earlier flights, in their order, then flies until there is an answer: at most so many
/// in all, and so many at once.
SearchEnd search(Axis& axis, std::uint64_t most, std::size_t at_once,
                 std::span<const Wanted> earlier, const FlyThem& fly, const TakeOne& take);

// What `tether size` asks, and what it learns from each flight.

struct Question {
  double success = 0.9;      ///< the share of flights that must succeed, in (0, 1)
  double confidence = 0.95;  ///< of the threshold's interval, in (0, 1)
  double interval = 1.3;     ///< upper over lower bound at which the answer is narrow enough, > 1
  double least = 1.0;        ///< slowdowns to fly: between these, 0 < least < most
  double most = 40.0;
};

/// The slowdowns that may be flown: 10^(k/160), rounded to three digits, within the question's
/// range. Ascending.
std::vector<double> slowdowns_of(const Question& question);

/// The outcome of a flight.
struct Flight {
  double slowdown = 1.0;  ///< > 0
  bool reached = false;
  /// How far the worst limited metric was within its limit (negative: beyond), in shares of the
  /// limit; none if a metric has no value. Positive or zero exactly if `reached`.
  std::optional<double> margin{};

  friend bool operator==(const Flight&, const Flight&) = default;
};

/// An estimate with the bounds of its interval.
struct Estimate {
  double estimate = 0.0;
  double low = 0.0;
  double high = 0.0;
};
/// The largest slowdown at which the share of successful flights is still the wanted one.
using Threshold = Estimate;
/// Of flights that succeed.
using Share = Estimate;

}  // namespace tether::sizing
