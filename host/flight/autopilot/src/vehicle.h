#pragma once

#include "local_frame.h"
#include "modes.h"
#include "mount.h"
#include "parameters.h"

#include <cstdint>
#include <optional>
#include <vector>

#include <tether/base/time.h>
#include <tether/uav/multirotor.h>
#include <tether/uav/samples.h>

namespace tether::autopilot {

/// What the parts of the built-in controller share.
struct Vehicle {
  explicit Vehicle(const Parameters& initial) : parameters(initial) {}

  Parameters parameters;
  LocalFrame frame;
  uav::FlightLimits limits;
  double hover_thrust_N = 0.0;

  SimTime now{};
  uav::BodyState estimate;                        ///< in W
  std::optional<uav::OdometrySample> odometry{};  ///< of which it is; none: it is the truth
  std::optional<uav::BatterySample> battery{};

  bool is_armed = false;
  SimTime armed_at{};
  bool is_landed = true;
  std::optional<SimTime> landed_at{};  ///< since it is landed
  Mode mode = Mode::kHold;
  bool is_failsafe = false;
  uav::Vec3 home_W;
  double home_yaw_W_rad = 0.0;
  Mount mount;

  double parameter(Parameter which) const { return parameters[which]; }
  Duration time_parameter(Parameter which) const {
    return duration_from_seconds(parameters[which]);
  }
};

}  // namespace tether::autopilot
