#include "sizing_of.h"

#include <algorithm>

#include <tether/base/error.h>
#include <tether/scenario/scenario.h>

namespace tether::runner {
std::optional<campaign::Sizing> sizing_of(const TrialSpec& spec,
                                          const scenario::ShippedFiles& shipped) try {
  if (!spec.scenario.settings.empty() || spec.scenario.has_laid_profile || spec.waits_for_sut)
    return std::nullopt;
  scenario::require_decidable(spec.scenario);
  const bool is_slowed = !spec.condition.slowed_from.empty();
  const std::string& moved_from = spec.condition.moved_from;
  scenario::Condition slower =
      scenario::pick_condition(spec.scenario, is_slowed            ? spec.condition.slowed_from
                                              : moved_from.empty() ? spec.condition.name
                                                                   : moved_from);
  if (spec.condition.simulator != slower.simulator) return std::nullopt;
  campaign::Sizing sizing{
      .scenario = shipped.name_of(scenario::ShippedKind::kScenario, spec.scenario.file),
      .condition = slower.name};
  if (!moved_from.empty()) {
    const auto& target = computer_of(spec.condition, 0).target;
    if (is_slowed || !target || target->file.empty() || !slower.seats.empty()) return std::nullopt;
    scenario::slowness(*target, spec.scenario, slower);
    sizing.target = target->file.string();
  }
  // The answer may be on either side of what was flown.
  constexpr double kBeside = 4.0;
  const double flown = spec.condition.slowdown;
  if (is_slowed) sizing.between = {std::min(1.0, flown / kBeside), std::max(40.0, flown * kBeside)};
  scenario::slow_down(slower, 2.0);
  return sizing;
} catch (const Error&) {
  return std::nullopt;
}

}  // namespace tether::runner
