#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace tether::app {

/// One line for a command line that cannot be parsed: what is wrong with it, and which command
/// prints the help.
std::string complaint(const CLI::App& program, const CLI::ParseError& error);

}  // namespace tether::app
