#pragma once

#include <functional>
#include <string>

#include <CLI/CLI.hpp>

namespace tether::app {

/// One line for a command line that cannot be parsed: what is wrong with it, and which command
/// prints the help. `advice`: what to do about a word that is neither a command, an option nor an
/// argument; empty: unknown.
std::string complaint(const CLI::App& program, const CLI::ParseError& error,
                      const std::function<std::string(const std::string& word)>& advice = nullptr);

}  // namespace tether::app
