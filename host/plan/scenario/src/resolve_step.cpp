#include <fmt/format.h>

#include <tether/scenario/scenario.h>

namespace tether::scenario {

void resolve_step(const Scenario& scenario, sim::World& world) {
  if (scenario.step) {
    world.step = *scenario.step;
    world.step_from = "scenario";
    world.step_at = scenario.step_at;
  }
  if (scenario.ground_truth_at.file.empty() || scenario.ground_truth_period >= world.step) return;
  throw Error(ErrorCode::kBadFile, scenario.ground_truth_at,
              fmt::format("'ground_truth_period_ms' is {}, which is less than the step of {} ms{}",
                          1e3 * to_seconds(scenario.ground_truth_period),
                          1e3 * to_seconds(world.step), sim::set_at(world)))
      .about("ground_truth_period_ms");
}

}  // namespace tether::scenario
