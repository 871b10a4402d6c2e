#pragma once

#include <array>
#include <string_view>

namespace tether::computer {

/// How recorded time is charged.
enum class ReplayMode {
  kExact,      ///< each call gets the times that it had in the run of the same UAV and seed
  kResampled,  ///< drawn from the times of the stage, keyed by seed, UAV, stage and index
  kScaled,     ///< the same × counted work of the new build / of the one that was recorded
};
/// In the order of ReplayMode.
inline constexpr std::array<std::string_view, 3> kReplayModes = {"exact", "resampled", "scaled"};

/// What stages are charged that the timing does not have.
enum class UnknownStages {
  kRefused,  ///< they end the run
  kCounted,  ///< drawn from their times under a counted clock
  kZero,
};
/// In the order of UnknownStages.
inline constexpr std::array<std::string_view, 3> kUnknownStages = {"refused", "counted", "zero"};

}  // namespace tether::computer
