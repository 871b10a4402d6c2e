#include "simulator_script.h"

#include <tether/sim_testing/fake_simulator.h>

namespace tether::fuzz {

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

void fly_script(sim::Simulator& simulator) {
  const std::size_t sensors = simulator.world().uavs[0].sensors.size();
  simulator.reset(1);
  for (const int ms : {3, 60}) {
    simulator.apply(0, {{1.0, 0.0, 0.0}, 0.1});
    simulator.advance_to(SimTime(std::chrono::milliseconds(ms)));
    sim::Snapshot snapshot;
    simulator.capture(snapshot);
    for (std::size_t i = 0; i < sensors; ++i) (void)simulator.measure(snapshot, 0, i, 0);
  }
  (void)simulator.ground_truth(0);
}

}  // namespace tether::fuzz
