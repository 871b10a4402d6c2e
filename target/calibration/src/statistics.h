#pragma once

#include <string>
#include <vector>

#include <tether/base/result.h>
#include <tether/calibration/calibration.h>

/// What times say of a machine, and of two.
namespace tether::calibration {

/// Half of the times lie within the quartiles. Between two times values are interpolated.
struct Quartiles {
  double lower = 0.0;
  double median = 0.0;
  double upper = 0.0;

  /// Distance of the quartiles as a share of the median.
  double spread() const { return (upper - lower) / median; }
};
/// @pre not empty
Quartiles quartiles(std::vector<double> values);

struct Interval {
  double low = 0.0;
  double high = 0.0;
};
/// Of the median, from order statistics: whatever the distribution, it holds the true one with a
/// probability of at least 97.5 %. @pre at least kLeastRounds values
Interval median_interval(std::vector<double> values);

/// Seconds of CPU time on one machine per second on the other.
struct Factor {
  std::string block;
  double value = 1.0;
  Interval interval;  ///< 95 %
};

struct Comparison {
  std::vector<Factor> blocks;  ///< the whole step last
  Factor overall;              ///< geometric mean of the blocks without the whole step
  Factor whole;                ///< of the whole step

  /// The blocks, without the whole step, of the least and of the greatest factor.
  const Factor& least() const;
  const Factor& greatest() const;
};

/// How much more CPU time `there` takes than `here`. Fails (kInvalid) with one line where they have
/// not the same blocks, or too few rounds.
Result<Comparison> compare(const Calibration& here, const Calibration& there);

/// What makes a measurement doubtful, a line each: other programs took the core meanwhile, times
/// rose or fell from the first rounds to the last, they scatter, the clock rate changed.
std::vector<std::string> doubts(const Calibration& calibration);

}  // namespace tether::calibration
