#include "gazebo_server.h"

#include <algorithm>
#include <utility>

#include <tether/base/error.h>
#include <tether/sim_gazebo/gazebo_simulator.h>
#include <tether/sim_remote/remote_simulator.h>

namespace tether::sim {

namespace {

bool has_camera(const World& world) {
  return std::ranges::any_of(world.uavs, [](const Uav& uav) {
    return std::ranges::any_of(uav.sensors, [](const Sensor& sensor) {
      return sensor.kind() == uav::SensorKind::kCamera;
    });
  });
}

}  // namespace

GazeboSimulator::GazeboSimulator(World world, const GazeboSetup& setup)
    : stop_(setup.stop),
      server_(std::make_unique<GazeboServer>(GazeboRun{.install = find_gazebo(),
                                                       .world = world.file,
                                                       .draws = has_camera(world),
                                                       .log = setup.log,
                                                       .stop = setup.stop})) {
  auto connection = server_->connect();
  try {
    simulator_ = make_remote_simulator(std::move(world), std::move(connection),
                                       {.open_limit = server_->start_limit(),
                                        .answer_limit = setup.answer_limit,
                                        .why_give_up = [this] { return why_give_up(); },
                                        .on_silence = setup.on_silence},
                                       setup.warn);
  } catch (const Error& e) {
    throw Error(e.code(), e.what() + post_mortem());
  }
  server_->check_world();
}

GazeboSimulator::~GazeboSimulator() = default;

std::optional<std::string> GazeboSimulator::lost() {
  return server_->lost();
}

std::optional<std::string> GazeboSimulator::why_give_up() {
  if (stop_.stop_requested()) return "interrupted by the user";
  return simulator_ ? lost() : server_->why_not_up();
}

std::string GazeboSimulator::post_mortem() {
  return stop_.stop_requested() ? "" : server_->post_mortem();
}

}  // namespace tether::sim
