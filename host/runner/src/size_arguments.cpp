#include "size_arguments.h"

#include <algorithm>

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/scenario/decidable.h>
#include <tether/scenario/slowness.h>

namespace tether::runner {
namespace {

std::string word_for(const std::filesystem::path& scenario, const scenario::ShippedFiles& shipped) {
  std::error_code failed;
  return std::filesystem::equivalent(shipped.folder() / "scenarios" / scenario.filename(), scenario,
                                     failed)
             ? scenario.stem().string()
             : scenario.string();
}

/// Of the scenario's conditions, the one that was moved to a target of the command line.
const scenario::Condition& moved_from(const TrialSpec& spec) {
  const auto& all = spec.scenario.conditions;
  const auto found = std::ranges::find_if(all, [&](const scenario::Condition& one) {
    return spec.condition.name.starts_with(one.name + " on ");
  });
  return found == all.end() ? all.front() : *found;
}

}  // namespace

std::vector<std::string> size_arguments(const TrialSpec& spec,
                                        const scenario::ShippedFiles& shipped) try {
  if (!spec.scenario.settings.empty() || spec.scenario.has_laid_profile || spec.waits_for_sut)
    return {};
  scenario::require_decidable(spec.scenario);
  const bool is_slowed = !spec.condition.slowed_from.empty();
  const scenario::Condition* own =
      spec.scenario.find_condition(is_slowed ? spec.condition.slowed_from : spec.condition.name);
  scenario::Condition slower = own != nullptr ? *own : moved_from(spec);
  if (spec.condition.simulator != slower.simulator) return {};
  std::vector<std::string> words = {word_for(spec.scenario.file, shipped), "--condition",
                                    slower.name};
  if (own == nullptr) {
    const auto& target = computer_of(spec.condition, 0).target;
    if (is_slowed || !target || target->file.empty() || !slower.seats.empty()) return {};
    scenario::slowness(*target, spec.scenario, slower);
    words.insert(words.end(), {"--target", target->file.string()});
  }
  // The answer may be on either side of what was flown.
  constexpr double kBeside = 4.0;
  const double flown = spec.condition.slowdown;
  if (is_slowed)
    words.insert(words.end(), {"--between", fmt::format("{:g},{:g}", std::min(1.0, flown / kBeside),
                                                        std::max(40.0, flown * kBeside))});
  scenario::slow_down(slower, 2.0);
  return words;
} catch (const Error&) {
  return {};
}

}  // namespace tether::runner
