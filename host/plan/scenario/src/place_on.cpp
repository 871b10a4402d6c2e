#include <fmt/format.h>

#include <tether/scenario/scenario.h>

namespace tether::scenario {

std::string why_not_on(const Condition& condition, const Target& target) {
  const bool is_counted = target.clock.kind == computer::ClockKind::kCounted;
  if (condition.policy == Policy::kFreeRunning && target.clock.needs_barrier())
    return fmt::format(
        "the target \"{}\" {}, which needs policy = \"conservative_barrier\", because free running "
        "uses the real wall clock. Select another condition, or another target.",
        target.name, is_counted ? "counts work" : "scales the wall clock");
  for (const Seat& seat : condition.seats)
    if (target.clock.kind == computer::ClockKind::kWall && seat.pinned_core)
      return fmt::format(
          "a UAV has a 'pinned_core' of the target \"{}\", which needs a modelled computer, but "
          "\"{}\" has a wall clock. Use a target with the clock \"cpu\" or \"counted\", or remove "
          "'pinned_core'.",
          condition.computers[seat.computer].name, target.name);
  if (target.ssh && condition.computers.size() > 1)
    return fmt::format(
        "{} targets cannot all be the board at {}. Give each [[target]] its own file.",
        condition.computers.size(), to_string(*target.ssh));
  return "";
}

void place_on(Condition& condition, const Target& target) {
  if (const std::string why = why_not_on(condition, target); !why.empty()) {
    throw Error(ErrorCode::kUsage, fmt::format("condition \"{}\": {}", condition.name, why))
        .about(condition.name);
  }
  for (Computer& computer : condition.computers) {
    computer.clock = target.clock;
    computer.target = target;
    if (condition.seats.empty()) continue;
    if (target.clock.kind == computer::ClockKind::kWall) computer.cores = 0;
    if (target.clock.kind != computer::ClockKind::kWall) computer.target->cores = 0;
  }
  condition.replay.reset();
}

}  // namespace tether::scenario
