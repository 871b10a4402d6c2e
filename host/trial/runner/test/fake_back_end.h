#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <tether/base/error.h>
#include <tether/base_testing/scratch_folder.h>
#include <tether/runner/trial.h>
#include <tether/scenario/scenario.h>
#include <tether/sim_testing/fake_simulator.h>

namespace tether::runner {

/// A simulator without physics; the test says whether its processes are lost.
class FakeRunningSimulator final : public RunningSimulator {
 public:
  FakeRunningSimulator(sim::World world, std::optional<std::string> lost)
      : simulator_(std::move(world)), lost_(std::move(lost)) {}

  sim::Simulator& get() override { return simulator_; }
  std::optional<std::string> lost() override { return lost_; }
  std::string post_mortem() override { return lost_ ? "; more" : ""; }

 private:
  sim::FakeSimulator simulator_;
  std::optional<std::string> lost_;
};

/// Finds only the simulator "fake". `lost`: why it is lost from its start on.
inline FindBackEnd fake_back_end(std::optional<std::string> lost = std::nullopt) {
  return [lost](const std::string& name) -> BackEnd {
    if (name != "fake") throw Error(ErrorCode::kUsage, "unknown simulator").about(name);
    return {.prepare = [lost](sim::World world, const sim::WarningSink&) -> StartSimulator {
              return [world, lost](const SimulatorSetup&) {
                return std::make_unique<FakeRunningSimulator>(world, lost);
              };
            },
            .files = [] { return std::vector<std::filesystem::path>{"/fake/simulator"}; }};
  };
}

/// Flies the scenario in an empty world, which loads at once.
inline void fly_in_empty_world(scenario::Scenario& scenario, const ScratchFolder& folder) {
  scenario.world = folder.write("empty.sdf", "<sdf version='1.7'><world name='w'/></sdf>");
  scenario.anchors.clear();
}

}  // namespace tether::runner
