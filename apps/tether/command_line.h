#pragma once

#include <optional>

#include <tether/os/interrupt.h>

namespace tether::app {

/// Reads the command line, and does what it says; from then on there is an interrupt.
/// @return the program's exit code.
int run_command_line(int argc, char** argv, std::optional<os::Interrupt>& interrupt);

}  // namespace tether::app
