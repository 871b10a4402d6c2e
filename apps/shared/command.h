#pragma once

#include "shared/option.h"

#include <string>

#include <CLI/CLI.hpp>

namespace tether::app {

void add_options(CLI::App& command, const Options& options);

/// Adds the command of these words to the program; "world check" to its command "world".
CLI::App* add_command(CLI::App& program, const std::string& words, const std::string& help,
                      const Options& options, const std::string& footer);

}  // namespace tether::app
