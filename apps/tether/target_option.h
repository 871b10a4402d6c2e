#pragma once

#include <filesystem>
#include <string>
#include <variant>

#include <tether/scenario/target.h>

namespace tether::app {

/// Somebody else starts the SUT, on whatever machine: `--target wait`.
struct WaitForSut {};

/// What `--target` names: nothing, a file, a board's address, or nobody yet.
using TargetOption =
    std::variant<std::monostate, std::filesystem::path, scenario::SshAddress, WaitForSut>;

/// "" is nothing, "wait" is WaitForSut, what has a "://" is an address, and all else is a file's
/// name. Looks at no file.
/// @throws Error(kUsage) as `scenario::parse_ssh_address`.
TargetOption parse_target_option(const std::string& text);

}  // namespace tether::app
