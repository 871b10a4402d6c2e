#pragma once

#include <string_view>

namespace tether::scenario {

/// How a SUT's time is measured (docs/design.md section 2).
enum class Clock { kWall, kCpu, kScripted, kUnstamped, kCounted, kReplayed };
/// As written in files: "wall", "cpu", "scripted", "unstamped", "counted", "replayed".
std::string_view name(Clock clock);

}  // namespace tether::scenario
