#include "parameters.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <tether/autopilot/flight_controller.h>

namespace tether::autopilot {
namespace {

constexpr ParameterInfo kInfos[] = {
    {"BAT_CRIT_THR", 0.07, 0.0, 1.0, false, "critical charge, a share"},
    {"BAT_EMERGEN_THR", 0.05, 0.0, 1.0, false, "charge at which it lands"},
    {"BAT_LOW_THR", 0.15, 0.0, 1.0, false, "below, it warns and does not arm"},
    {"COM_DISARM_LAND", 2.0, -1.0, 20.0, false, "disarms after landing [s]; −1: never"},
    {"COM_DISARM_PRFLT", 10.0, -1.0, 60.0, false,
     "disarms on the ground after arming [s]; −1: never"},
    {"COM_LOW_BAT_ACT", 0, 0, 3, true,
     "0 warn, 2 land at `BAT_CRIT_THR`, 3 return then, land at `BAT_EMERGEN_THR`"},
    {"COM_OBL_RC_ACT", 0, 0, 5, true, "OFFBOARD without set-points: 3 return, 4 land, others hold"},
    {"COM_OF_LOSS_T", 1.0, 0.0, 60.0, false, "for so long without set-points [s]"},
    {"MIS_TAKEOFF_ALT", 2.5, 0.0, 80.0, false, "default height of take-offs [m]"},
    {"MPC_ACC_HOR", 3.0, 0.5, 15.0, false, "horizontal acceleration [m/s²]"},
    {"MPC_LAND_SPEED", 0.7, 0.2, 2.0, false, "descent in the last 5 m [m/s]"},
    {"MPC_TKO_SPEED", 1.5, 0.2, 5.0, false, "take-off [m/s]"},
    {"MPC_XY_CRUISE", 5.0, 0.5, 20.0, false, "horizontal, in automatic modes [m/s]"},
    {"MPC_YAWRAUTO_MAX", 45.0, 5.0, 360.0, false, "yaw rate in automatic modes [°/s]"},
    {"MPC_Z_V_AUTO_DN", 1.5, 0.5, 4.0, false, "descent in automatic modes [m/s]"},
    {"MPC_Z_V_AUTO_UP", 3.0, 0.5, 8.0, false, "ascent in automatic modes [m/s]"},
    {"NAV_ACC_RAD", 2.0, 0.05, 200.0, false, "distance of a reached waypoint [m]"},
    {"NAV_MC_ALT_RAD", 0.8, 0.05, 200.0, false, "vertical distance of it [m]"},
    {"RTL_DESCEND_ALT", 10.0, 0.0, 100.0, false, "height over home from which a return lands [m]"},
    {"RTL_MIN_DIST", 10.0, 0.5, 100.0, false, "nearer, a return does not climb [m]"},
    {"RTL_RETURN_ALT", 30.0, 0.0, 150.0, false, "height over home of a return [m]"},
};

}  // namespace

std::span<const ParameterInfo> parameter_infos() {
  return kInfos;
}

std::optional<std::size_t> find_parameter(std::string_view name) {
  const auto found = std::ranges::lower_bound(kInfos, name, {}, &ParameterInfo::name);
  if (found == std::end(kInfos) || found->name != name) return std::nullopt;
  return static_cast<std::size_t>(found - std::begin(kInfos));
}

std::string complaint_about_parameter(const std::string& name, double value) {
  const auto index = find_parameter(name);
  if (!index) {
    std::string names;
    for (const ParameterInfo& info : kInfos)
      names += (names.empty() ? "" : ", ") + std::string(info.name);
    return "is no parameter of the built-in flight controller. It has " + names + ".";
  }
  const ParameterInfo& info = kInfos[*index];
  const bool is_whole = !info.is_integer || value == std::round(value);
  if (value >= info.min && value <= info.max && is_whole) return {};
  return fmt::format("is {:g}; it must be {}from {:g} to {:g}.", value,
                     info.is_integer ? "a whole number " : "", info.min, info.max);
}

Parameters::Parameters(const std::map<std::string, double>& values) {
  for (const ParameterInfo& info : kInfos) values_.push_back(info.initial);
  for (const auto& [name, value] : values) set(*find_parameter(name), value);
}

void Parameters::set(std::size_t index, double value) {
  const ParameterInfo& info = kInfos[index];
  if (std::isnan(value)) return;
  const double bounded = std::clamp(value, info.min, info.max);
  values_[index] = info.is_integer ? std::round(bounded) : bounded;
}

}  // namespace tether::autopilot
