#include "back_ends.h"

#include "options/simulator_option.h"

#include <memory>
#include <utility>

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/sim_gazebo/gazebo_install.h>
#include <tether/sim_gazebo/gazebo_simulator.h>
#include <tether/sim_gazebo/gazebo_world.h>
#include <tether/sim_mujoco/mujoco_simulator.h>
#include <tether/sim_remote/remote_simulator.h>
#include <tether/sim_sdf/sdf_version.h>

namespace tether::app {

namespace {

using runner::SimulatorSetup;

constexpr Duration kAttachLimit = std::chrono::seconds(5);

/// The embedded simulator, or an external one.
class WithoutProcesses final : public runner::RunningSimulator {
 public:
  explicit WithoutProcesses(std::unique_ptr<sim::Simulator> simulator)
      : simulator_(std::move(simulator)) {}
  sim::Simulator& get() override { return *simulator_; }

 private:
  std::unique_ptr<sim::Simulator> simulator_;
};

class InGazebo final : public runner::RunningSimulator {
 public:
  InGazebo(sim::World world, const SimulatorSetup& setup)
      : gazebo_(std::move(world),
                {setup.answer_limit, setup.log, setup.warn, setup.on_silence, setup.stop}) {}
  sim::Simulator& get() override { return gazebo_.get(); }
  std::optional<std::string> lost() override { return gazebo_.lost(); }
  std::string post_mortem() override { return gazebo_.post_mortem(); }

 private:
  sim::GazeboSimulator gazebo_;
};

std::unique_ptr<sim::Simulator> attach(const sim::protocol::Endpoint& endpoint, sim::World world,
                                       const SimulatorSetup& setup) {
  auto connection = sim::protocol::connect(endpoint, kAttachLimit);
  if (!connection)
    throw Error(ErrorCode::kSetup,
                fmt::format("cannot connect to the simulator at {}: {}",
                            sim::protocol::to_string(endpoint), connection.failure().message))
        .about(sim::protocol::to_string(endpoint));
  return sim::make_remote_simulator(
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

/// A simulator without processes and files; `make` returns it.
template <class Make>
runner::BackEnd without_processes(Make make, void (*require_readable)(const sim::World&)) {
  return {.require_readable = require_readable,
          .start =
              [make](sim::World world, const SimulatorSetup& setup) {
                return std::make_unique<WithoutProcesses>(make(std::move(world), setup));
              },
          .files = [] { return std::vector<std::filesystem::path>{}; }};
}

runner::BackEnd back_end(EmbeddedSimulator) {
  return without_processes(
      [](sim::World world, const SimulatorSetup& setup) {
        return sim::make_mujoco_simulator(std::move(world), setup.warn, setup.threads_ahead);
      },
      [](const sim::World&) {});
}

runner::BackEnd back_end(const sim::protocol::Endpoint& endpoint) {
  return without_processes(
      [endpoint](sim::World world, const SimulatorSetup& setup) {
        return attach(endpoint, std::move(world), setup);
      },
      sim::require_remote_cameras);
}

runner::BackEnd back_end(GazeboSimulator) {
  return {.require_readable =
              [](const sim::World& world) {
                sim::check_sdf_version(world, {.name = "Gazebo 11"});
                sim::check_gazebo_world(world);
                sim::require_remote_cameras(world);
              },
          .start =
              [](sim::World world, const SimulatorSetup& setup) {
                if (setup.on_setup) setup.on_setup("starting Gazebo");
                return std::make_unique<InGazebo>(std::move(world), setup);
              },
          .files = [] { return sim::find_gazebo().files(); }};
}

}  // namespace

runner::BackEnd find_back_end(const std::string& name) {
  return std::visit([](const auto& option) { return back_end(option); },
                    parse_simulator_option(name));
}

}  // namespace tether::app
