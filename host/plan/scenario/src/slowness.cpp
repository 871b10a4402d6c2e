#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/scenario/scenario.h>

namespace tether::scenario {
namespace {

/// Of a target whose flights draw other power than those of the condition.
bool has_another_power(const Target& target, const Scenario& scenario, const Condition& condition) {
  if (!target.power) return false;
  for (std::size_t i = 0; i < scenario.uavs.size(); ++i) {
    if (scenario.uavs[i].energy && *target.power != power_of(scenario, condition, i)) return true;
  }
  return false;
}

std::string why_not_comparable(const Target& target, const Scenario& scenario,
                               const Condition& condition) {
  if (target.ssh)
    return "is a board without a factor. Calibrate it (tether-sut calibrate --write-target), and "
           "give that file.";
  if (computer_of(condition, 0).clock.kind == computer::ClockKind::kScripted)
    return fmt::format("cannot be compared with condition \"{}\", whose time is scripted.",
                       condition.name);
  if ((target.clock.kind == computer::ClockKind::kCounted) !=
      (computer_of(condition, 0).clock.kind == computer::ClockKind::kCounted))
    return fmt::format(
        "cannot be compared with condition \"{}\": one has counted costs, the other "
        "a factor. Use a condition with the clock \"{}\".",
        condition.name, target.clock.kind == computer::ClockKind::kCounted ? "counted" : "cpu");
  const auto& own_target = computer_of(condition, 0).target;
  if (!target.emulator &&
      target.launcher != (own_target ? own_target->launcher : std::vector<std::string>{}))
    return fmt::format(
        "has another 'launcher' than condition \"{}\" flies with, or only one of them has one. "
        "Give the condition this target (`target` in the file), and size it.",
        condition.name);
  if (has_another_power(target, scenario, condition))
    return fmt::format(
        "has another [power] than condition \"{}\" flies with, and the scenario simulates energy. "
        "Give the condition this target (`target` in the file), and size it.",
        condition.name);
  if (target.clock.kind != computer::ClockKind::kCounted) return "";
  const os::Emulator& own = *computer_of(condition, 0).target->emulator;
  if (own.program != target.emulator->program || own.cpu_model != target.emulator->cpu_model)
    return fmt::format(
        "cannot be compared with condition \"{}\", which counts with another "
        "emulator or CPU model.",
        condition.name);
  return "";
}

Slowness by_costs(const os::Emulator& target, const os::Emulator& own) {
  std::pair<double, double> bounds{HUGE_VAL, 0.0};
  for (std::size_t i = 0; i < own.cost_units.size(); ++i) {
    const double ratio =
        static_cast<double>(target.cost_units[i]) / static_cast<double>(own.cost_units[i]);
    bounds = {std::min(bounds.first, ratio), std::max(bounds.second, ratio)};
  }
  return {std::sqrt(bounds.first * bounds.second), bounds};
}

}  // namespace

Slowness slowness(const Target& target, const Scenario& scenario, const Condition& condition) {
  const auto require = [&](const std::string& why) {
    if (!why.empty())
      throw Error(ErrorCode::kUsage, {target.file.string()}, why).about(target.file.string());
  };
  require(why_not_comparable(target, scenario, condition));
  if (target.clock.kind != computer::ClockKind::kCounted) {
    const double own = computer_of(condition, 0).clock.factor;
    Slowness result{.factor = target.clock.factor / own};
    if (const auto& bounds = target.cpu_factor_interval)
      result.bounds = {bounds->first / own, bounds->second / own};
    return result;
  }
  return by_costs(*target.emulator, *computer_of(condition, 0).target->emulator);
}

}  // namespace tether::scenario
