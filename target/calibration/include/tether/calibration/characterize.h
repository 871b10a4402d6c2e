#pragma once

#include <functional>
#include <string>
#include <vector>

#include <tether/base/result.h>
#include <tether/base/time.h>
#include <tether/client/vehicle.h>
#include <tether/tasks/sensor_characterization_task.h>
#include <tether/tasks/task.h>
#include <tether/uav/catalogue.h>

/// The paper's Section IV: what acquiring each sensor's data takes, by Algorithm 1.
namespace tether::calibration {

/// What a profile is to say of a sensor's time.
enum class Timing {
  kAuto,      ///< periodic where a sensor tells a rate and can be modelled so, else on demand
  kOnDemand,  ///< the time from asking to having: what Algorithm 1 measures
  kPeriodic,  ///< the sensor's own period, and how long after its instant a sample arrives
};

struct CharacterizeOptions {
  std::vector<std::string> sensors;  ///< names; empty: all of the catalogue
  int acquisitions = 100;            ///< of each experiment; 1 to kMostAcquisitions
  int experiments = 1;               ///< of each sensor; likewise; the paper made ten
  Timing timing = Timing::kAuto;
  Duration time_limit = std::chrono::minutes(10);  ///< of each sensor, on the SUT's clock
  std::string name;                                ///< of the profile
  std::string out;                                 ///< the profile's file; empty: none
};

/// What was measured of one sensor.
struct SensorTimes {
  std::string sensor;
  uav::SensorKind kind = uav::SensorKind::kCamera;
  std::vector<std::vector<tasks::Acquisition>> experiments;
  double rate_hz = 0.0;  ///< as the catalogue tells it; 0: none

  /// Asking to having, of all experiments, in the order in which they were made.
  std::vector<Duration> taken() const;
};

struct Characterization {
  tasks::TaskOutcome outcome;  ///< of the whole; see `characterize`
  std::vector<SensorTimes> sensors;
};

/// Of all sensors together: so many fit a profile of the size that a scenario's reader takes (1
/// MiB), whatever they took.
inline constexpr int kMostAcquisitions = 60'000;
/// Whether those of so many sensors fit one profile: kInvalid, one line.
Status check_extent(const CharacterizeOptions& options, std::size_t sensors);

/// Told what begins: "camera: experiment 2 of 10".
using TellProgress = std::function<void(const std::string&)>;

/// Runs Algorithm 1 over each sensor in turn, after one reading of it that is not counted, and ends
/// with the first one that fails or does not reach its number of acquisitions.
///
/// The outcome's results: "duration_s"; of each sensor SENSOR_n, SENSOR_mean_s, _stddev_s, _min_s,
/// _median_s, _p95_s, _p99_s, _max_s, and from two experiments on _stddev_between_experiments_s.
/// Fails (kInvalid) before it measures anything for a sensor that is not there, for one that tells
/// no rate where a period is asked for (a rangefinder or an IMU of a rig; a virtual sensor that
/// measures on demand), and for more acquisitions than fit a profile.
Characterization characterize(client::Vehicle& vehicle, const CharacterizeOptions& options,
                              const TellProgress& tell = {});

}  // namespace tether::calibration
