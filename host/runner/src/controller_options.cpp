#include "controller_options.h"

#include <algorithm>
#include <utility>

#include <tether/autopilot/built_in.h>
#include <tether/autopilot/px4.h>
#include <tether/base/error.h>

namespace tether::runner {
namespace {

using coordinator::ControllerOptions;

std::uint8_t system_id(std::size_t uav) {
  return static_cast<std::uint8_t>(1 + uav % 250);
}

ControllerOptions built_in(const scenario::FlightController& controller, const sim::World& world,
                           std::size_t uav) {
  const sim::Uav& own = world.uavs[uav];
  const auto estimator =
      std::ranges::find(own.sensors, uav::SensorKind::kOdometry, &sim::Sensor::kind);
  const autopilot::BuiltInSettings settings{
      .system_id = system_id(uav),
      .place = world.place.value_or(sim::Place{}),
      .limits = flight_limits(own.airframe),
      .hover_thrust_N = own.airframe.mass_kg * world.gravity_m_s2,
      .starts_in_air = controller.starts_in_air,
      .parameters = controller.parameters};
  return {.name = "built-in",
          .estimate = estimator == own.sensors.end() ? "truth" : estimator->name,
          .make = [settings] { return make_built_in(settings); },
          .period = autopilot::kBuiltInPeriod};
}

ControllerOptions px4(const scenario::FlightController& controller, const sim::World& world,
                      std::size_t uav, std::uint64_t seed, const std::filesystem::path& folder) {
  if (uav >= autopilot::kMostPx4)
    throw Error(ErrorCode::kBadFile, controller.at,
                "PX4's ports are for ten UAVs at most. Give the others another flight controller.")
        .about("flight_controller");
  const autopilot::Px4Settings settings{
      .build = controller.path,
      .folder = std::filesystem::absolute(folder / (world.uavs[uav].name + ".px4")),
      .instance = static_cast<int>(uav),
      .seed = seed,
      .place = world.place.value_or(sim::Place{}),
      .magnetic_field_T = world.magnetic_field_T,
      .gravity_m_s2 = world.gravity_m_s2,
      .vehicle = world.uavs[uav],
      .parameters = controller.parameters,
      .boot = controller.boot};
  return {.name = "PX4",
          .estimate = "its sensors",
          .make = [settings] { return start_px4(settings); },
          .period = autopilot::kPx4Period,
          .repeats = false};
}

}  // namespace

ControllerOptions controller_options(const scenario::FlightController& controller,
                                     const sim::Simulator& simulator, std::size_t uav,
                                     std::uint64_t seed, const std::filesystem::path& folder) {
  if (!simulator.takes_setpoints())
    throw Error(ErrorCode::kBadFile, controller.at,
                "'flight_controller' needs a simulator that follows any set-point. Use the "
                "embedded one (simulator = \"mujoco\").")
        .about("flight_controller");
  using Kind = scenario::FlightController::Kind;
  ControllerOptions options = controller.kind == Kind::kPx4
                                  ? px4(controller, simulator.world(), uav, seed, folder)
                                  : built_in(controller, simulator.world(), uav);
  options.period = simulator.grid().ceil(SimTime(options.period)).time_since_epoch();
  options.link_baud = controller.link_baud;
  options.link_latency = controller.link_latency;
  return options;
}

}  // namespace tether::runner
