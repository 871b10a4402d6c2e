#include "test_simulator.h"

#include <filesystem>

#include <gtest/gtest.h>

#include <tether/sim_mujoco/mujoco_simulator.h>
#include <tether/sim_sdf/load_world.h>

namespace tether::sim::testing {

WarningSink no_warnings() {
  return [](const Warning& warning) { ADD_FAILURE() << to_line(warning); };
}

std::unique_ptr<Simulator> make_simulator(World world) {
  return make_mujoco_simulator(std::move(world), no_warnings());
}

World shipped_world(const std::string& name) {
  const std::filesystem::path root = TETHER_SOURCE_DIR;
  WorldRequest request;
  request.world = root / "data/worlds" / name;
  request.uavs = {{"alpha", root / "data/models/hummingbird/model.sdf", {1.2, 0.0, 1.2}, 0.3}};
  request.anchors = {"blue_box"};
  return load_world(request, no_warnings());
}

}  // namespace tether::sim::testing
