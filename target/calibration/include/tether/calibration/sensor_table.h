#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tether/base/time.h>
#include <tether/calibration/characterize.h>

/// Table I of the paper, and the distributions behind its means.
namespace tether::calibration {

/// Statistics of a sample of times.
struct TimeSummary {
  std::size_t n = 0;
  double mean_s = 0.0;
  std::optional<double> stddev_s;  ///< of a sample; none of a single time
  double min_s = 0.0;
  double median_s = 0.0;
  double p95_s = 0.0;
  double p99_s = 0.0;
  double max_s = 0.0;
};

/// Quantiles are interpolated linearly. @pre not empty
TimeSummary summarize(std::vector<Duration> times);

/// Standard deviation of the means of the experiments [s]; none for a single experiment.
std::optional<double> stddev_between_experiments_s(const SensorTimes& times);

/// Origin of the data and location of the SUT in Table I.
struct Origin {
  std::string data;      ///< "real sensor" or "virtual"
  std::string location;  ///< the host's name, and of a virtual target its clock
};

/// The mean of each sensor, above the paper's three rows.
std::string table_1(const Origin& origin, const std::vector<SensorTimes>& sensors);

/// Times with a name: one row of the distribution table.
struct NamedTimes {
  std::string name;
  std::vector<Duration> times;  ///< not empty
  std::optional<double> stddev_between_experiments_s;
};
/// n, mean, sd, min, median, p95, p99, max of each, in milliseconds.
std::string distribution_table(const std::vector<NamedTimes>& rows);

}  // namespace tether::calibration
