#pragma once

#include <optional>
#include <vector>

/// What the times that a task measured come to. Of any unit; pure.
namespace tether::tasks {

/// @pre not empty
double mean(const std::vector<double>& values);

/// Standard deviation of a sample (over n − 1); none of fewer than two values.
std::optional<double> sample_stddev(const std::vector<double>& values);

/// Interpolated between the two nearest values; 0.5 is the median. @pre sorted, not empty,
/// 0 ≤ share ≤ 1
double quantile(const std::vector<double>& sorted, double share);

}  // namespace tether::tasks
