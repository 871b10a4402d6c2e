#include "controller_options.h"

#include <algorithm>
#include <utility>

#include <tether/autopilot/built_in.h>
#include <tether/base/error.h>

namespace tether::runner {

coordinator::ControllerOptions controller_options(const scenario::FlightController& controller,
                                                  const sim::Simulator& simulator,
                                                  std::size_t uav) {
  if (!simulator.takes_setpoints())
    throw Error(ErrorCode::kBadFile, controller.at,
                "'flight_controller' needs a simulator that follows any set-point. Use the "
                "embedded one (simulator = \"mujoco\").")
        .about("flight_controller");
  const sim::World& world = simulator.world();
  const sim::Uav& own = world.uavs[uav];
  const StepGrid grid = simulator.grid();
  const auto estimator =
      std::ranges::find(own.sensors, uav::SensorKind::kOdometry, &sim::Sensor::kind);
  const autopilot::BuiltInSettings settings{
      .system_id = static_cast<std::uint8_t>(1 + uav % 250),
      .place = world.place.value_or(sim::Place{}),
      .limits = flight_limits(own.airframe),
      .hover_thrust_N = own.airframe.mass_kg * world.gravity_m_s2,
      .starts_in_air = controller.starts_in_air,
      .parameters = controller.parameters};
  return {.name = "built-in",
          .estimate = estimator == own.sensors.end() ? "truth" : estimator->name,
          .make = [settings] { return make_built_in(settings); },
          .period = grid.ceil(SimTime(autopilot::kBuiltInPeriod)).time_since_epoch(),
          .link_baud = controller.link_baud,
          .link_latency = controller.link_latency};
}

}  // namespace tether::runner
