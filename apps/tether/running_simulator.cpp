#include "running_simulator.h"

#include <utility>

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/sim/sdf_version.h>
#include <tether/sim_gazebo/gazebo_world.h>
#include <tether/sim_mujoco/mujoco_simulator.h>
#include <tether/sim_remote/remote_simulator.h>

namespace tether::app {

namespace {

constexpr Duration kAttachLimit = std::chrono::seconds(5);

}  // namespace

void require_readable(const sim::World& world, const SimulatorOption& option) {
  if (!std::holds_alternative<GazeboSimulator>(option)) return;
  sim::check_sdf_version(world, {.name = "Gazebo 11"});
  sim::check_gazebo_world(world);
}

RunningSimulator::RunningSimulator(const SimulatorOption& option, sim::World world,
                                   SimulatorSetup setup) {
  if (std::holds_alternative<GazeboSimulator>(option)) {
    if (setup.on_setup) setup.on_setup("starting Gazebo");
    gazebo_ = std::make_unique<sim::GazeboSimulator>(
        std::move(world),
        sim::GazeboSetup{setup.answer_limit, setup.log, setup.warn, setup.on_silence, setup.stop});
  } else if (const auto* endpoint = std::get_if<sim::protocol::Endpoint>(&option)) {
    attach(*endpoint, std::move(world), setup);
  } else {
    simulator_ = sim::make_mujoco_simulator(std::move(world), setup.warn);
  }
}

void RunningSimulator::attach(const sim::protocol::Endpoint& endpoint, sim::World world,
                              const SimulatorSetup& setup) {
  auto connection = sim::protocol::connect(endpoint, kAttachLimit);
  if (!connection)
    throw Error(ErrorCode::kSetup,
                fmt::format("no simulator listens at {}: {}", sim::protocol::to_string(endpoint),
                            connection.failure().message));
  simulator_ = sim::make_remote_simulator(
      std::move(world), std::move(*connection),
      {.answer_limit = setup.answer_limit,
       .why_give_up = [stop = setup.stop]() -> std::optional<std::string> {
         if (!stop.stop_requested()) return std::nullopt;
         return "interrupted by the user";
       },
       .on_silence = setup.on_silence,
       .address = sim::protocol::to_string(endpoint)},
      setup.warn);
}

std::optional<std::string> RunningSimulator::lost() {
  return gazebo_ ? gazebo_->lost() : std::nullopt;
}

std::string RunningSimulator::post_mortem(const std::string& said) {
  return gazebo_ ? gazebo_->post_mortem(said) : "";
}

}  // namespace tether::app
