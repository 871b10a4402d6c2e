#pragma once

#include <optional>
#include <string>
#include <variant>

#include <tether/calibration/calibration.h>
#include <tether/calibration/characterize.h>
#include <tether/devices/rig.h>
#include <tether/rig/mission.h>

namespace tether::sut {

/// A parsed command line. `address`, `uav` and `clock` override the environment.
struct CommandLine {
  rig::Mission mission;  ///< empty for characterize and calibrate
  std::optional<calibration::CharacterizeOptions> characterize;  ///< instead of a mission
  std::optional<calibration::CalibrateOptions> calibrate;        ///< instead of a mission
  rig::RealRowOptions real_row;     ///< of a single relative_position task with real devices
  std::optional<devices::Rig> rig;  ///< real devices instead of a coordinator
  std::optional<std::string> address;
  std::optional<std::string> uav;
  std::optional<std::string> clock;
  bool only_checks = false;  ///< nothing is left to do
};

/// A text to print instead of running a command, and the exit code: 0 for --help, --version,
/// the manual page and the script for a shell, 2 for wrong use, with one line.
struct Refusal {
  int exit_code = 2;
  std::string text;
};

std::variant<CommandLine, Refusal> parse_command_line(int argc, const char* const* argv);

}  // namespace tether::sut
