#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tether/base/result.h>
#include <tether/base/time.h>
#include <tether/calibration/characterize.h>

/// From acquisitions to the model of a sensor's time in a profile.
namespace tether::calibration {

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

}  // namespace tether::calibration
