#pragma once

#include <filesystem>
#include <string>

namespace tether::os {

/// This program's own file.
std::filesystem::path own_file();
/// The file that a command starts: beside this program's own file, else in PATH; a name with '/' is
/// taken as it is.
/// @throws Error(kSetup) when there is none.
std::filesystem::path find_program(const std::string& name);

}  // namespace tether::os
