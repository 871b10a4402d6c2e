#pragma once

#include <optional>

#include <tether/os/interrupt.h>

namespace tether::app {

/// Parses the command line and runs the command. Sets `interrupt` before it runs.
/// @return the exit code of the program.
int run_command_line(int argc, char** argv, std::optional<os::Interrupt>& interrupt);

}  // namespace tether::app
