#pragma once

#include <optional>
#include <vector>

/// Summaries of samples, in the unit of the values. Pure.
namespace tether::stats {

/// @pre not empty
double mean(const std::vector<double>& values);

/// Standard deviation of a sample (over n − 1); none for fewer than two values.
std::optional<double> sample_stddev(const std::vector<double>& values);

/// Interpolated between the two nearest values (type 7 of Hyndman and Fan, 1996); 0.5 is the
/// median. @pre sorted, not empty, 0 ≤ share ≤ 1
double quantile(const std::vector<double>& sorted, double share);

}  // namespace tether::stats
