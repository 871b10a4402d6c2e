#include "back_ends.h"

#include <algorithm>
#include <memory>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/sim/simulator.h>
#include <tether/sim_gazebo/gazebo_simulator.h>
#include <tether/sim_mujoco/mujoco_simulator.h>
#include <tether/sim_protocol/connection.h>
#include <tether/sim_remote/remote_simulator.h>
#include <tether/sim_sdf/load_world.h>

namespace tether::app {

namespace {

using runner::SimulatorSetup;
using runner::StartSimulator;

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

std::vector<std::filesystem::path> no_files() {
  return {};
}

/// In this process.
runner::BackEnd embedded() {
  const auto prepare = [](sim::World world, const sim::WarningSink& warn) -> StartSimulator {
    sim::check_step(world, sim::Controller::kOurs, warn);
    return [make = sim::prepare_mujoco_simulator(
                std::move(world), warn, sim::FileCache::of_user())](const SimulatorSetup& setup) {
      return std::make_unique<WithoutProcesses>(make(setup.warn, setup.threads_ahead));
    };
  };
  return {prepare, no_files};
}

/// Started by the user, at that address.
runner::BackEnd external(const sim::protocol::Endpoint& endpoint) {
  const auto prepare = [endpoint](sim::World world,
                                  const sim::WarningSink& warn) -> StartSimulator {
    sim::check_step(world, sim::Controller::kUnknown, warn);
    sim::require_remote_cameras(world);
    return [endpoint, world = std::move(world)](const SimulatorSetup& setup) {
      return std::make_unique<WithoutProcesses>(attach(endpoint, world, setup));
    };
  };
  return {prepare, no_files};
}

/// Started and ended by this program.
runner::BackEnd gazebo() {
  const auto prepare = [](sim::World world, const sim::WarningSink& warn) -> StartSimulator {
    sim::check_step(world, sim::Controller::kOurs, warn);
    sim::check_sdf_version(world, {.name = "Gazebo 11"});
    sim::check_gazebo_world(world);
    sim::require_remote_cameras(world);
    return [world = std::move(world)](const SimulatorSetup& setup) {
      if (setup.on_setup) setup.on_setup("starting Gazebo");
      return std::make_unique<InGazebo>(world, setup);
    };
  };
  return {prepare, [] { return sim::find_gazebo().files(); }, true};
}

struct Row {
  std::string_view name;
  runner::BackEnd (*make)();
};
constexpr Row kBackEnds[] = {{"mujoco", embedded}, {"gazebo", gazebo}};

}  // namespace

runner::BackEnd find_back_end(const std::string& name) {
  const auto* const row = std::ranges::find(kBackEnds, name, &Row::name);
  if (row != std::end(kBackEnds)) return row->make();
  if (const auto endpoint = sim::protocol::parse_endpoint(name)) return external(*endpoint);
  throw Error(ErrorCode::kUsage,
              fmt::format("unknown simulator \"{}\". Use mujoco, gazebo, or the address of an "
                          "external simulator, unix:/path or tcp://host:port",
                          name))
      .about(name);
}

}  // namespace tether::app
