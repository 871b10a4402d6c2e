#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <tether/base/result.h>
#include <tether/calibration/timing_model.h>
#include <tether/uav/catalogue.h>

/// What was measured, as a profile that a scenario can name (docs/guide/sensors.md).
namespace tether::calibration {

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
/// The nearest profile name to any text.
std::string profile_name_from(std::string text);

/// As a TOML string, whatever bytes it has.
std::string toml_string(std::string_view text);
/// In one line, as in a comment: UTF-8 without control characters.
std::string plain(std::string_view text);

/// Whether a scenario's reader takes every delay: at most 60 s. Fails (kInvalid) with one line that
/// names the sensor.
Status check_delays(const MeasuredProfile& profile);

/// The profile's file, TOML, whatever bytes the texts have: every delay in milliseconds, exact to
/// the nanosecond.
std::string profile_text(const MeasuredProfile& profile);

}  // namespace tether::calibration
