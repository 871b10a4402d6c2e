#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tether/base/result.h>
#include <tether/base/time.h>
#include <tether/calibration/characterize.h>

/// From acquisitions to what a profile says of a sensor's time.
namespace tether::calibration {

struct TimingModel {
  std::optional<Duration> period;  ///< none: measures on demand
  std::vector<Duration> delays;    ///< in the order in which they were measured; not empty
};

/// Each acquisition's time from asking to having. @pre there is an acquisition
TimingModel on_demand_timing(const SensorTimes& times);

/// The period is the mean step of the samples' instants per index, of those within a fifth of the
/// median; a delay is the time from a sample's instant to having it. An experiment's first sample
/// is left out: it may have been there for a while.
///
/// Fails (kInvalid, one line) where
/// - the period cannot be told: fewer than three steps, fewer than three in four of them within a
///   fifth of the median, or a period that no profile can have;
/// - the instants and this program's clock do not run at one pace, so that their difference is no
///   delay: the delays drift by more than 2 % of the measured span and a period, and by more than
///   jitter alone explains (four standard errors of the drift, and more of few samples);
/// - a sample is from the future;
/// - the instants cannot be the sensor's own: of a live device that may stamp what it has no
/// instant
///   for with its arrival, a median delay below 5 ms: that is what decoding takes, and less than
///   any camera's exposure and transfer.
Result<TimingModel> periodic_timing(const SensorTimes& times, bool may_stamp_arrival);

/// The model that is asked for, and why it is not the one that was hoped for.
struct ChosenTiming {
  TimingModel model;
  std::string note;  ///< one line; empty: nothing to say
};

/// `Timing::kAuto`: a sensor that tells a rate gets `periodic_timing`, if that can be, and any
/// other `on_demand_timing`. Fails (kInvalid) as `periodic_timing`, if that is asked for.
Result<ChosenTiming> choose_timing(const SensorTimes& times, Timing timing, bool may_stamp_arrival);

}  // namespace tether::calibration
