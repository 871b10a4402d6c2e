#pragma once

#include "mission.h"

#include <optional>
#include <string>
#include <variant>

namespace tether::sut {

/// What was asked for on the command line. `address`, `uav` and `clock` override the environment.
struct CommandLine {
  Mission mission;
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
