#pragma once

#include <optional>
#include <vector>

/// What `tether size` asks, and what it learns from each flight.
namespace tether::sizing {

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
