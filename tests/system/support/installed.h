#pragma once

#include "process.h"

#include <filesystem>
#include <string>
#include <vector>

namespace tether::system_test {

/// The client library as a user's machine has it: the components client and client-dev of this
/// build, installed below a folder. @throws std::runtime_error with the output of what failed.
void install_client(const std::filesystem::path& prefix);

/// Runs to the end and returns what it printed. @throws std::runtime_error with its output if it
/// does not exit with 0.
std::string output_of(const std::vector<std::string>& arguments,
                      const std::vector<std::pair<std::string, std::string>>& environment = {},
                      const std::filesystem::path& working_folder = {});

/// Folder below `prefix` in which a file of that name was installed. @throws if there is none.
std::filesystem::path folder_of(const std::filesystem::path& prefix, const std::string& file);

}  // namespace tether::system_test
