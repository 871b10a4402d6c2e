#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tether/base/time.h>
#include <tether/calibration/characterize.h>

/// Table I of the paper, and what its means do not show.
namespace tether::calibration {

/// Of a sample of times [s].
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

/// Quantiles between two times are interpolated. @pre not empty
TimeSummary summarize(std::vector<Duration> times);

/// Standard deviation of the experiments' means [s]; none of a single experiment.
std::optional<double> stddev_between_experiments_s(const SensorTimes& times);

/// How Table I names where the data came from and where the SUT ran.
struct Origin {
  std::string data;      ///< "real sensor" or "virtual"
  std::string location;  ///< the host's name, and of a virtual target its clock
};

/// The mean of each sensor, and below it the paper's three rows for the kinds that it has.
std::string table_1(const Origin& origin, const std::vector<SensorTimes>& sensors);

/// A row of times under a name: the distribution behind one mean.
struct NamedTimes {
  std::string name;
  std::vector<Duration> times;  ///< not empty
  std::optional<double> stddev_between_experiments_s;
};
/// n, mean, sd, min, median, p95, p99, max of each, in milliseconds.
std::string distribution_table(const std::vector<NamedTimes>& rows);

}  // namespace tether::calibration
