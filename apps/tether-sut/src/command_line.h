#pragma once

#include <optional>
#include <string>
#include <variant>

#include <tether/calibration/calibrate.h>
#include <tether/calibration/characterize.h>
#include <tether/devices/rig.h>
#include <tether/rig/mission.h>
#include <tether/rig/real_row.h>

namespace tether::sut {

/// What was asked for on the command line. `address`, `uav` and `clock` override the environment.
struct CommandLine {
  rig::Mission mission;  ///< without tasks, if to characterize
  std::optional<calibration::CharacterizeOptions> characterize;  ///< instead of a mission
  std::optional<calibration::CalibrateOptions> calibrate;        ///< instead of all else
  rig::RealRowOptions real_row;     ///< of a lone relative_position with a rig
  std::optional<devices::Rig> rig;  ///< real devices instead of a coordinator
  std::optional<std::string> address;
  std::optional<std::string> uav;
  std::optional<std::string> clock;
};

/// Nothing to fly: what to print instead, and the exit code (0 for --help and --version, 2 for
/// wrong use, with one line).
struct Refusal {
  int exit_code = 2;
  std::string text;
};

std::variant<CommandLine, Refusal> parse_command_line(int argc, const char* const* argv);

}  // namespace tether::sut
