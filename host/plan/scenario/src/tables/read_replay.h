#pragma once

#include <string_view>
#include <vector>

#include <tether/scenario/scenario.h>
#include <tether/toml/table.h>

namespace tether::scenario {

/// The keys of a condition with computer::ClockKind::kReplayed.
inline constexpr std::string_view kReplayKeys[] = {"timing", "mode", "counted", "unknown_stages"};

/// Reads these keys of a condition, whose clock and policy are known. With another clock, none of
/// them is allowed. @throws Error(kBadFile) as `load_scenario`.
std::optional<ReplaySource> read_replay(const toml::Table& table, const Condition& condition,
                                        Scenario& scenario);

}  // namespace tether::scenario
