#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace tether::autopilot {

/// Flight modes, by PX4's names.
enum class Mode : std::uint8_t { kPosition, kTakeoff, kHold, kMission, kReturn, kLand, kOffboard };

struct ModeInfo {
  Mode mode;
  std::string_view name;
  std::uint8_t main;  // of HEARTBEAT's custom_mode
  std::uint8_t sub;
};

/// In the order of Mode.
inline constexpr ModeInfo kModes[] = {
    {Mode::kPosition, "POSCTL", 3, 0},   {Mode::kTakeoff, "AUTO.TAKEOFF", 4, 2},
    {Mode::kHold, "AUTO.LOITER", 4, 3},  {Mode::kMission, "AUTO.MISSION", 4, 4},
    {Mode::kReturn, "AUTO.RTL", 4, 5},   {Mode::kLand, "AUTO.LAND", 4, 6},
    {Mode::kOffboard, "OFFBOARD", 6, 0},
};

constexpr const ModeInfo& info(Mode mode) {
  return kModes[static_cast<std::size_t>(mode)];
}
constexpr std::uint32_t custom_mode(Mode mode) {
  return std::uint32_t{info(mode).sub} << 24 | std::uint32_t{info(mode).main} << 16;
}
/// None: the controller does not have it.
constexpr std::optional<Mode> mode_of(std::int64_t main, std::int64_t sub) {
  constexpr std::int64_t kAuto = 4;  // others have no sub-modes
  for (const ModeInfo& row : kModes)
    if (row.main == main && (row.sub == sub || main != kAuto)) return row.mode;
  return std::nullopt;
}

}  // namespace tether::autopilot
