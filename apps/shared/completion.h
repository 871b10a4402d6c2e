#pragma once

#include <array>
#include <string>
#include <string_view>

#include <CLI/CLI.hpp>

namespace tether::app {

inline constexpr std::array<std::string_view, 3> kShells = {"bash", "zsh", "fish"};

/// A script that completes the commands, options and choices of a program in a shell of kShells,
/// and file names everywhere else. Arguments named as a kind of shipped file ("scenario") also get
/// the names that `PROGRAM list` prints below that heading.
std::string completion_script(const CLI::App& program, std::string_view shell);

/// Adds the command "completion", which takes the name of a shell.
CLI::App* add_completion_command(CLI::App& program, std::string& shell);

}  // namespace tether::app
