#include "socket_connection.h"
#include "socket_pair.h"

#include <tether/sim_remote/remote_simulator.h>
#include <tether/sim_testing/fake_simulator.h>

/// The host's side of the simulator protocol, with a simulator that has said everything beforehand.
/// Input: what it says.
namespace tether::fuzz {
namespace {

/// One UAV with a camera, an IMU and a rangefinder before a box that moves.
sim::World scripted_world() {
  sim::World world = sim::make_fake_world(1);
  world.file = "/worlds/fuzz.sdf";
  sim::Model box;
  box.name = "box";
  box.X_WM.p = {4.0, 0.0, 1.0};
  sim::Link& link = box.links.emplace_back();
  link.name = "link";
  link.visuals.push_back({"visual", {}, sim::BoxGeometry{{1.0, 1.0, 1.0}}, {}});
  link.collisions.push_back({"collision", {}, sim::BoxGeometry{{1.0, 1.0, 1.0}}});
  world.models.push_back(std::move(box));
  return world;
}

/// Requests of every kind, the same each time.
void fly_script(sim::Simulator& simulator) {
  const std::size_t sensors = simulator.world().uavs[0].sensors.size();
  simulator.reset(1);
  for (const int ms : {3, 60}) {
    simulator.apply(0, uav::to_setpoint({{1.0, 0.0, 0.0}, 0.1}));
    simulator.advance_to(SimTime(std::chrono::milliseconds(ms)));
    sim::Snapshot snapshot;
    simulator.capture(snapshot);
    for (std::size_t i = 0; i < sensors; ++i) (void)simulator.measure(snapshot, 0, i, 0);
  }
  (void)simulator.ground_truth(0);
}

}  // namespace
}  // namespace tether::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tether;
  fuzz::SpokenFor simulator({data, size});
  auto connection = sim::protocol::make_connection(simulator.take_ours(), "simulator");
  const auto flown = [&] {
    const auto remote = sim::make_remote_simulator(
        fuzz::scripted_world(), std::move(connection), {},
        [](const Warning& warning) { fuzz::require_one_line(to_line(warning)); });
    fuzz::fly_script(*remote);
    fuzz::require_one_line(remote->description());
    return true;
  };
  (void)fuzz::read_or_refuse(flown, {ErrorCode::kSetup});
  return 0;
}
