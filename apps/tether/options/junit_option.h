#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace tether::app {

/// What `--junit FILE` does to a command. The file says from the start that the command did not
/// end, and the reason as soon as it throws, so that it is there however the command ends. `action`
/// replaces it. If `file` is empty, only `action` is called, whose exit code this returns.
/// @param suite name of the suite until there are results.
/// @throws Error(kUsage) as require_output_file, and Error(kSetup) if the file cannot be written,
/// before anything else; what `action` throws.
int with_junit(const std::filesystem::path& file, const std::string& suite,
               const std::function<int()>& action);

}  // namespace tether::app
