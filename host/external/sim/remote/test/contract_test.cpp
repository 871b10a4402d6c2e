#include <memory>

#include <tether/sim_remote/remote_simulator.h>
#include <tether/sim_remote_testing/fake_external_simulator.h>
#include <tether/sim_testing/simulator_contract.h>

namespace tether::sim::testing {
namespace {

std::unique_ptr<Simulator> make_served(World world) {
  world.file = "/worlds/test.sdf";
  auto external = std::make_shared<FakeExternalSimulator>(world);
  auto connection = external->take_connection();
  RemoteOptions options;
  // Shared, so that it lives as long as the simulator that it serves.
  options.why_give_up = [external] { return std::nullopt; };
  return make_remote_simulator(std::move(world), std::move(connection), std::move(options),
                               [](const Warning& warning) {
                                 EXPECT_THAT(to_line(warning), ::testing::HasSubstr("velocities"));
                               });
}

}  // namespace

INSTANTIATE_TEST_SUITE_P(Remote, SimulatorContract, ::testing::Values(SimulatorMaker(make_served)));

}  // namespace tether::sim::testing
