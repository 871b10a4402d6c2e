#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tether/base/result.h>
#include <tether/base/time.h>
#include <tether/client/vehicle.h>
#include <tether/tasks/paper_tasks.h>
#include <tether/tasks/task.h>
#include <tether/uav/catalogue.h>

/// The paper's Section IV: the time to acquire each sensor's data, by Algorithm 1.
namespace tether::calibration {

/// Model of a sensor's time in a profile.
enum class Timing {
  kAuto,      ///< periodic if the sensor has a rate and fits the model, else on demand
  kOnDemand,  ///< the time from request to result, which Algorithm 1 measures
  kPeriodic,  ///< the sensor's period, and the delay from a sample's timestamp to its arrival
};

struct CharacterizeOptions {
  std::vector<std::string> sensors;  ///< names; empty: all of the catalogue
  int acquisitions = 100;            ///< of each experiment; 1 to kMostAcquisitions
  int experiments = 1;               ///< of each sensor; 1 to kMostAcquisitions; ten in the paper
  Timing timing = Timing::kAuto;
  Duration time_limit = std::chrono::minutes(10);  ///< of each sensor, on the SUT's clock
  std::string name;                                ///< of the profile
  std::string out;                                 ///< the profile's file; empty: none
};

/// The measurements of one sensor.
struct SensorTimes {
  std::string sensor;
  uav::SensorKind kind = uav::SensorKind::kCamera;
  std::vector<std::vector<tasks::Acquisition>> experiments;
  double rate_hz = 0.0;  ///< from the catalogue; 0: none

  /// Times from request to result of all experiments, in their order.
  std::vector<Duration> taken() const;
};

struct Characterization {
  tasks::TaskOutcome outcome;  ///< of the whole; see `characterize`
  std::vector<SensorTimes> sensors;
};

/// Maximum for all sensors together: this number fits a profile of the largest size that a scenario
/// can use (1 MiB), with any delays.
inline constexpr int kMostAcquisitions = 60'000;
/// Checks that the acquisitions of that many sensors fit one profile. Fails with kInvalid.
Status check_extent(const CharacterizeOptions& options, std::size_t sensors);

/// Receives each step as it begins: "camera: experiment 2 of 10".
using TellProgress = std::function<void(const std::string&)>;

/// Runs Algorithm 1 for each sensor in turn, after one reading that is not counted. Stops at the
/// first sensor that fails or does not reach its number of acquisitions.
///
/// Results of the outcome: "duration_s"; for each sensor SENSOR_n, SENSOR_mean_s, _stddev_s,
/// _min_s, _median_s, _p95_s, _p99_s, _max_s, and with two or more experiments
/// _stddev_between_experiments_s. Fails with kInvalid before any measurement for an unknown sensor,
/// for one without a rate if a period is requested (a rangefinder or IMU of a rig; a virtual sensor
/// that measures on demand), and for more acquisitions than fit a profile.
Characterization characterize(client::Vehicle& vehicle, const CharacterizeOptions& options,
                              const TellProgress& tell = {});

// ---- From acquisitions to the model of a sensor's time in a profile.

struct TimingModel {
  std::optional<Duration> period;  ///< none: measures on demand
  std::vector<Duration> delays;    ///< in the order in which they were measured; not empty
};

/// The time from request to result of each acquisition. @pre there is an acquisition
TimingModel on_demand_timing(const SensorTimes& times);

/// The period is the mean step of the timestamps per index, of the steps within a fifth of their
/// median. A delay is the time from a sample's timestamp to its arrival. The first sample of each
/// experiment is ignored, because it can have waited before the request.
///
/// Fails with kInvalid and one line if
/// - the period cannot be determined: fewer than three steps, fewer than three in four of them
///   within a fifth of the median, or a period that a profile cannot have;
/// - the timestamps and this program's clock run at different speeds, so that their difference is
///   not a delay: the delays drift by more than 2 % of the measured span and a period, and by more
///   than jitter explains (four standard errors of the drift, and more for few samples);
/// - a timestamp is in the future;
/// - `may_stamp_arrival` (a live device) and the median delay is below 5 ms, which is less than the
///   exposure and transfer of any camera: then the timestamps are probably times of arrival.
Result<TimingModel> periodic_timing(const SensorTimes& times, bool may_stamp_arrival);

/// A model, and why it is not the preferred one.
struct ChosenTiming {
  TimingModel model;
  std::string note;  ///< one line; empty: nothing to say
};

/// `Timing::kAuto`: `periodic_timing` for a sensor with a rate if that succeeds, else
/// `on_demand_timing`. `Timing::kPeriodic` fails as `periodic_timing`.
Result<ChosenTiming> choose_timing(const SensorTimes& times, Timing timing, bool may_stamp_arrival);

// Measurements as a profile for scenarios (docs/guide/sensors.md).

struct ProfiledSensor {
  std::string name;
  uav::SensorKind kind = uav::SensorKind::kCamera;
  std::string source;  ///< its device, or "virtual"; a URL's user and password are not written
  TimingModel timing;
};

struct MeasuredProfile {
  std::string name;      ///< @pre is_profile_name
  std::string when;      ///< "2025-03-01T12:00:00Z"
  std::string where;     ///< "bench-pi"
  int acquisitions = 0;  ///< of each experiment
  int experiments = 0;   ///< of each sensor
  std::vector<ProfiledSensor> sensors;
};

/// 1 to 64 letters, digits, '_', '-' and '.', not starting with '.'.
bool is_profile_name(std::string_view name);
/// A profile name that is similar to the text.
std::string profile_name_from(std::string text);

/// The text, of any bytes, as a TOML string.
std::string toml_string(std::string_view text);
/// The text as one line of UTF-8 without control characters, as for a comment.
std::string plain(std::string_view text);

/// Checks that every delay is at most 60 s, the maximum in a profile. Fails with kInvalid and one
/// line that names the sensor.
Status check_delays(const MeasuredProfile& profile);

/// The profile's TOML file, with every delay in milliseconds, exact to the nanosecond. Texts can
/// contain any bytes.
std::string profile_text(const MeasuredProfile& profile);

// Table I of the paper, and the distributions behind its means.

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

// Output files, with failures as values instead of exceptions. Thread-safe for different paths.

/// Checks, without writing, whether `write_whole` can write `path` now. Fails with kInvalid and one
/// line if its folder does not exist or is not writable, or if `path` is not a regular file.
Status check_writable(const std::string& path);

/// Writes all of `bytes` to `path` or leaves it unchanged (see os::write_file_atomically). Fails
/// with kInvalid and one line that names `path`.
Status write_whole(const std::string& path, std::string_view bytes);

}  // namespace tether::calibration
