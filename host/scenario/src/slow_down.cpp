#include <cmath>

#include <fmt/format.h>

#include <tether/scenario/scenario.h>

namespace tether::scenario {
namespace {

/// Empty: it can be slowed down.
std::string why_not_slower(const Condition& condition) {
  if (condition.target && condition.target->ssh)
    return "its SUTs run on a board, which cannot be slowed down. Use a virtual target.";
  if (condition.clock == Clock::kReplayed && condition.replay->mode == timing::Mode::kExact)
    return "its time is replayed call by call, which a slower program would not repeat. Use mode "
           "= \"resampled\" or \"scaled\".";
  if (condition.clock == Clock::kUnstamped)
    return "the clock \"unstamped\" has no factor. Use \"cpu\", \"wall\" or \"scripted\".";
  if (condition.clock == Clock::kWall && condition.policy == Policy::kFreeRunning)
    return "in free running, the wall clock cannot be stretched. Use clock = \"cpu\".";
  return "";
}

/// Of a Condition or a Computer.
void stretch(auto& computer, double slowdown) {
  if (computer.clock == Clock::kScripted) {
    const double computing_ns = static_cast<double>(computer.computing.count()) * slowdown;
    computer.computing = Duration(std::llround(computing_ns));
  } else if (computer.clock == Clock::kCounted) {
    for (std::uint64_t& units : computer.target->emulator->cost_units)
      units = static_cast<std::uint64_t>(std::llround(static_cast<double>(units) * slowdown));
  } else if (computer.clock != Clock::kReplayed) {  // by timing::ReplaySetting
    computer.cpu_factor *= slowdown;
  }
}

}  // namespace

void slow_down(Condition& condition, double slowdown) {
  const auto require = [&](const Condition& own) {
    if (const std::string why = why_not_slower(own); !why.empty())
      throw Error(ErrorCode::kUsage, fmt::format("condition \"{}\": {}", condition.name, why))
          .about(condition.name);
  };
  require(condition);
  for (std::size_t uav = 0; uav < condition.seats.size(); ++uav) require(for_uav(condition, uav));
  stretch(condition, slowdown);
  for (Computer& computer : condition.computers) stretch(computer, slowdown);
  condition.slowed_from = condition.name;
  condition.slowdown = slowdown;
  condition.name = fmt::format("{}, {} x slower", condition.slowed_from, slowdown);
}

}  // namespace tether::scenario
