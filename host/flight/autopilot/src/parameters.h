#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tether::autopilot {

/// The parameters of the built-in controller: PX4's names and units, each with an effect.
enum class Parameter : std::uint8_t {
  kBatCritical,
  kBatEmergency,
  kBatLow,
  kDisarmLanded_s,
  kDisarmPreflight_s,
  kLowBatteryAction,
  kOffboardLossAction,
  kOffboardLoss_s,
  kTakeoffAltitude_m,
  kAcceleration_m_s2,
  kLandSpeed_m_s,
  kTakeoffSpeed_m_s,
  kCruise_m_s,
  kYawRate_deg_s,
  kDown_m_s,
  kUp_m_s,
  kAcceptance_m,
  kAltitudeAcceptance_m,
  kReturnDescend_m,
  kReturnMinDistance_m,
  kReturnAltitude_m,
};

struct ParameterInfo {
  std::string_view name;
  double initial;
  double min;
  double max;
  bool is_integer;
  std::string_view meaning;  // for the guide
};

/// In the order of Parameter, which is that of their names.
std::span<const ParameterInfo> parameter_infos();
inline const ParameterInfo& info_of(Parameter parameter) {
  return parameter_infos()[static_cast<std::size_t>(parameter)];
}
std::optional<std::size_t> find_parameter(std::string_view name);

/// Their values.
class Parameters {
 public:
  /// @pre known, and within their limits
  explicit Parameters(const std::map<std::string, double>& values);
  double operator[](Parameter parameter) const {
    return values_[static_cast<std::size_t>(parameter)];
  }
  double value(std::size_t index) const { return values_[index]; }
  /// Integers are rounded, and values brought within their limits.
  void set(std::size_t index, double value);

 private:
  std::vector<double> values_;
};

}  // namespace tether::autopilot
