#pragma once

#include "commands/commands.h"

#include <optional>
#include <string>
#include <vector>

#include <tether/os/interrupt.h>

namespace tether::app {

/// Parses the command line and runs the command. Sets `interrupt` before it runs.
/// @return the exit code of the program.
int run_command_line(int argc, char** argv, std::optional<os::Interrupt>& interrupt);

/// The options that follow `tether run`. @throws CLI::ParseError.
RunOptions parse_run(std::vector<std::string> arguments);

}  // namespace tether::app
