#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <tether/base/error.h>
#include <tether/runner/back_end.h>
#include <tether/sim_testing/fake_simulator.h>

namespace tether::runner {

/// A simulator without physics, whose processes are up to the test.
class FakeRunningSimulator final : public RunningSimulator {
 public:
  FakeRunningSimulator(sim::World world, std::optional<std::string> lost)
      : simulator_(std::move(world)), lost_(std::move(lost)) {}

  sim::Simulator& get() override { return simulator_; }
  std::optional<std::string> lost() override { return lost_; }
  std::string post_mortem(const std::string& said) override {
    return lost_ && said == *lost_ ? "; it said more" : "";
  }

 private:
  sim::FakeSimulator simulator_;
  std::optional<std::string> lost_;
};

/// The only one there is: "fake". `lost`: why it is lost from its start on.
inline FindBackEnd fake_back_end(std::optional<std::string> lost = std::nullopt) {
  return [lost](const std::string& name) -> BackEnd {
    if (name != "fake") throw Error(ErrorCode::kUsage, "no simulator \"" + name + "\"");
    return {.require_readable = [](const sim::World&) {},
            .start =
                [lost](sim::World world, const SimulatorSetup&) {
                  return std::make_unique<FakeRunningSimulator>(std::move(world), lost);
                },
            .files = [] { return std::vector<std::filesystem::path>{"/fake/simulator"}; }};
  };
}

}  // namespace tether::runner
