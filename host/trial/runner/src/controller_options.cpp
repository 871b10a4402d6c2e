#include "controller_options.h"

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>

#include <tether/autopilot/external.h>
#include <tether/autopilot/flight_controller.h>
#include <tether/base/error.h>

namespace tether::runner {
namespace {

using coordinator::ControllerOptions;

std::uint8_t system_id(std::size_t uav) {
  return static_cast<std::uint8_t>(1 + uav % 250);
}

ControllerOptions built_in(const scenario::FlightController& controller,
                           const sim::Simulator& simulator, std::size_t uav) {
  const sim::World& world = simulator.world();
  const sim::Uav& own = world.uavs[uav];
  const auto estimator =
      std::ranges::find(own.sensors, uav::SensorKind::kOdometry, &sim::Sensor::kind);
  uav::FlightLimits limits = flight_limits(own.airframe);
  limits.joints = own.joints;
  const autopilot::BuiltInSettings settings{
      .system_id = system_id(uav),
      .place = world.place.value_or(sim::Place{}),
      .limits = limits,
      .hover_thrust_N = own.airframe.mass_kg * world.gravity_m_s2,
      .starts_in_air = controller.starts_in_air,
      .parameters = controller.parameters,
      .link_baud = controller.link_baud};
  return {.name = "built-in",
          .estimate = estimator == own.sensors.end() ? "truth" : estimator->name,
          .make = [settings] { return make_built_in(settings); },
          .period = simulator.grid().ceil(SimTime(autopilot::kBuiltInPeriod)).time_since_epoch()};
}

ControllerOptions external(const scenario::FlightController& controller,
                           const sim::Simulator& simulator, std::size_t uav, std::uint64_t seed,
                           const std::filesystem::path& folder) {
  const autopilot::External& kind = *controller.external;
  const sim::World& world = simulator.world();
  const sim::Uav& own = world.uavs[uav];
  const auto refuse = [&](const std::string& why) {
    throw Error(ErrorCode::kBadFile, controller.at, why).about("flight_controller");
  };
  if (uav >= kind.most_uavs)
    refuse(
        fmt::format("{} can fly the first {} UAVs only. Give the others another flight "
                    "controller.",
                    kind.name, kind.most_uavs));
  if (std::ranges::find(own.sensors, uav::SensorKind::kImu, &sim::Sensor::kind) ==
      own.sensors.end())
    refuse(fmt::format("{} needs an IMU, and the UAV '{}' has none. Add one to its model.",
                       kind.name, own.name));
  const Duration period = simulator.grid().ceil(SimTime(kind.period)).time_since_epoch();
  const autopilot::ExternalSettings settings{
      .build = controller.path,
      .folder = std::filesystem::absolute(folder / fmt::format("{}.{}", own.name, kind.key)),
      .instance = static_cast<int>(uav),
      .seed = seed,
      .period = period,
      .place = world.place.value_or(sim::Place{}),
      .magnetic_field_T = world.magnetic_field_T,
      .gravity_m_s2 = world.gravity_m_s2,
      .vehicle = own,
      .parameters = controller.parameters,
      .boot = controller.boot};
  return {.name = std::string(kind.name),
          .estimate = "its sensors",
          .make = [start = kind.start, settings] { return start(settings); },
          .period = period,
          .repeats = kind.repeats};
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
  ControllerOptions options = controller.external != nullptr
                                  ? external(controller, simulator, uav, seed, folder)
                                  : built_in(controller, simulator, uav);
  if (controller.ground_station != autopilot::GroundStation::kAbsent)
    options.make = [make = options.make, what = controller.ground_station,
                    port = controller.ground_station_port] {
      return with_ground_station(make(), what, port);
    };
  if (!controller.signing_key.empty())
    options.make = [make = options.make, key = controller.signing_key] {
      return with_signing(make(), key);
    };
  options.repeats =
      options.repeats && controller.ground_station != autopilot::GroundStation::kCommands;
  options.link_baud = controller.link_baud;
  options.link_latency = controller.link_latency;
  return options;
}

}  // namespace tether::runner
