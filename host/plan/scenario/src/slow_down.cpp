#include <cmath>

#include <fmt/format.h>

#include <tether/scenario/scenario.h>

namespace tether::scenario {
namespace {

/// Empty: it can be slowed down.
std::string why_not_slower(const Condition& condition, const Computer& computer) {
  const computer::ClockKind clock = computer.clock.kind;
  if (computer.target && computer.target->ssh)
    return "its SUTs run on a board, which cannot be slowed down. Use a virtual target.";
  if (clock == computer::ClockKind::kReplayed &&
      condition.replay->mode == computer::ReplayMode::kExact)
    return "its time is replayed call by call, which a slower program would not repeat. Use mode "
           "= \"resampled\" or \"scaled\".";
  if (clock == computer::ClockKind::kUnstamped)
    return "the clock \"unstamped\" has no factor. Use \"cpu\", \"wall\" or \"scripted\".";
  if (clock == computer::ClockKind::kWall && condition.policy == Policy::kFreeRunning)
    return "in free running, the wall clock cannot be stretched. Use clock = \"cpu\".";
  return "";
}

void stretch(Computer& computer, double slowdown) {
  if (computer.clock.kind == computer::ClockKind::kScripted) {
    const double computing_ns = static_cast<double>(computer.clock.computing.count()) * slowdown;
    computer.clock.computing = Duration(std::llround(computing_ns));
  } else if (computer.clock.kind == computer::ClockKind::kCounted) {
    for (std::uint64_t& units : computer.target->emulator->cost_units)
      units = static_cast<std::uint64_t>(std::llround(static_cast<double>(units) * slowdown));
  } else if (computer.clock.kind != computer::ClockKind::kReplayed) {  // by timing::ReplaySetting
    computer.clock.factor *= slowdown;
  }
}

}  // namespace

void slow_down(Condition& condition, double slowdown) {
  for (const Computer& computer : condition.computers)
    if (const std::string why = why_not_slower(condition, computer); !why.empty())
      throw Error(ErrorCode::kUsage, fmt::format("condition \"{}\": {}", condition.name, why))
          .about(condition.name);
  for (Computer& computer : condition.computers) stretch(computer, slowdown);
  condition.slowed_from = condition.name;
  condition.slowdown = slowdown;
  condition.name = slowdown < 1.0
                       ? fmt::format("{}, {:.4g} × faster", condition.slowed_from, 1.0 / slowdown)
                       : fmt::format("{}, {} × slower", condition.slowed_from, slowdown);
}

}  // namespace tether::scenario
