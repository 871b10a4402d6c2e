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
  return "";
}

void place_on(Condition& condition, Target target) {
  if (const std::string why = why_not_on(condition, target); !why.empty()) {
    throw Error(ErrorCode::kUsage, fmt::format("condition \"{}\": {}", condition.name, why))
        .about(condition.name);
  }
  condition.clock = target.clock;
  condition.cpu_factor = target.cpu_factor;
  condition.computing = Duration{0};
  condition.replay.reset();
  condition.target = std::move(target);
}

}  // namespace tether::scenario
