#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <tether/base/result.h>
#include <tether/calibration/characterize.h>
#include <tether/uav/catalogue.h>

/// Measurements as a profile for scenarios (docs/guide/sensors.md).
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

}  // namespace tether::calibration
