#include <fmt/format.h>

#include <tether/scenario/scenario.h>

namespace tether::scenario {

std::string why_not_on(const Condition& condition, const Target& target) {
  const bool is_scaled_wall = target.clock == Clock::kWall && target.cpu_factor != 1.0;
  if (condition.policy == Policy::kFreeRunning && is_scaled_wall) {
    return fmt::format(
        "the target \"{}\" scales the wall clock, which needs policy = \"conservative_barrier\", "
        "because free running uses the real wall clock.",
        target.name);
  }
  if (condition.policy == Policy::kFreeRunning && target.clock == Clock::kCounted) {
    return fmt::format(
        "the target \"{}\" counts instructions, which needs policy = \"conservative_barrier\", "
        "because free running uses the wall clock.",
        target.name);
  }
  for (std::size_t i = 0; i < condition.computers.size(); ++i)
    if (target.clock == Clock::kWall && is_shared(condition, i))
      return fmt::format(
          "several SUTs share the target \"{}\", but \"{}\" has a wall clock: SUTs that are held "
          "would give their share of its cores to the others. Use a target with the clock \"cpu\" "
          "or \"counted\", or a condition with shared = false.",
          condition.computers[i].name, target.name);
  if (target.ssh && condition.computers.size() > 1)
    return fmt::format(
        "{} targets cannot all be the board at {}. Give each [[target]] a file of its own.",
        condition.computers.size(), to_string(*target.ssh));
  return "";
}

void place_on(Condition& condition, Target target) {
  if (const std::string why = why_not_on(condition, target); !why.empty()) {
    throw Error(ErrorCode::kUsage, fmt::format("condition \"{}\": {}", condition.name, why))
        .about(condition.name);
  }
  for (Computer& computer : condition.computers) {
    computer.clock = target.clock;
    computer.cpu_factor = target.cpu_factor;
    computer.computing = Duration{0};
    computer.target = target;
    if (target.clock != Clock::kWall) computer.target->cores = 0;
  }
  condition.clock = target.clock;
  condition.cpu_factor = target.cpu_factor;
  condition.computing = Duration{0};
  condition.replay.reset();
  condition.target = std::move(target);
}

}  // namespace tether::scenario
