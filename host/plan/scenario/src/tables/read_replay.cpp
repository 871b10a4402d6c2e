#include "tables/read_replay.h"

#include <algorithm>
#include <string>

#include <fmt/format.h>

namespace tether::scenario {
namespace {

using computer::ReplayMode;
using computer::UnknownStages;

/// The reason why stages that were not recorded cannot take that; empty: they can.
std::string why_not(const ReplaySource& source, UnknownStages unknown) {
  if (unknown == UnknownStages::kRefused) return "";
  if (source.mode == ReplayMode::kExact)
    return "cannot be used with mode = \"exact\", in which every stage must be known.";
  if (unknown == UnknownStages::kCounted && source.counted.empty())
    return "is \"counted\", which needs the key 'counted': a timing file of the program that "
           "flies, of a run under a counted clock.";
  return "";
}

}  // namespace

std::optional<ReplaySource> read_replay(const toml::Table& table, const Condition& condition,
                                        Scenario& scenario) {
  if (computer_of(condition, 0).clock.kind != computer::ClockKind::kReplayed) {
    for (const std::string_view key : kReplayKeys)
      if (table.has(key)) table.fail(key, "needs clock = \"replayed\".");
    return std::nullopt;
  }
  ReplaySource source;
  source.timing = table.existing_file("timing");
  if (table.has("mode"))
    source.mode = static_cast<ReplayMode>(table.choice("mode", computer::kReplayModes));
  const bool is_scaled = source.mode == ReplayMode::kScaled;
  if (table.has("counted")) source.counted = table.existing_file("counted");
  if (table.has("unknown_stages")) {
    source.unknown =
        static_cast<UnknownStages>(table.choice("unknown_stages", computer::kUnknownStages));
    if (const std::string why = why_not(source, source.unknown); !why.empty())
      table.fail("unknown_stages", why);
  }
  if (is_scaled && source.counted.empty())
    table.fail("mode",
               "is \"scaled\", which needs the key 'counted': a timing file of the program "
               "that flies, of a run under a counted clock.");
  if (!source.counted.empty() && !is_scaled && source.unknown != UnknownStages::kCounted)
    table.fail("counted", "needs mode = \"scaled\" or unknown_stages = \"counted\".");
  scenario.files.push_back(source.timing);
  if (!source.counted.empty()) scenario.files.push_back(source.counted);
  return source;
}

void set_unknown_stages(Condition& condition, std::string_view name) {
  const auto refuse = [&](const std::string& why) {
    throw Error(ErrorCode::kUsage, fmt::format("--unknown-stages {}: {}", name, why))
        .about("--unknown-stages");
  };
  const auto found = std::ranges::find(computer::kUnknownStages, name);
  if (found == computer::kUnknownStages.end()) refuse("Allowed are refused, counted and zero.");
  if (!condition.replay)
    refuse(fmt::format("condition \"{}\" does not have clock = \"replayed\".", condition.name));
  const auto unknown = static_cast<UnknownStages>(found - computer::kUnknownStages.begin());
  if (const std::string why = why_not(*condition.replay, unknown); !why.empty()) refuse(why);
  condition.replay->unknown = unknown;
}

}  // namespace tether::scenario
