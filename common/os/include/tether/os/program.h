#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tether::os {

/// The file of this program.
std::filesystem::path own_file();
/// What follows the program's name on the command line by which this process was started.
std::vector<std::string> own_arguments();
/// The file that a command starts: in the folder of this program, else in PATH. A name with '/' is
/// a path.
/// @throws Error(kSetup), about the name, if there is no such program; about the file, if it is a
/// script without its interpreter.
std::filesystem::path find_program(const std::string& name);

/// @throws Error(kSetup), about the program, if no library can be preloaded into it, or if it does
/// not ask the C library for the time: it is static, set-user-ID, or written in Go.
void require_preloadable(const std::filesystem::path& program);

/// The text quoted so that a shell reads it as one word.
std::string shell_word(const std::string& text);

}  // namespace tether::os
