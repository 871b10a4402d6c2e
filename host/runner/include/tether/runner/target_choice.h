#pragma once

#include <filesystem>
#include <string>
#include <variant>

#include <tether/scenario/target.h>

namespace tether::app {

/// The user starts the SUT, on any machine: `--target wait`.
struct WaitForSut {};

/// The value of `--target`: none, a name or file, the address of a board, or "wait".
using TargetOption =
    std::variant<std::monostate, std::filesystem::path, scenario::SshAddress, WaitForSut>;

/// Parses the value: "" is none, "wait" is WaitForSut, a text with "://" is an address, and any
/// other text is a name or file. Reads no file.
/// @throws Error(kUsage) as `scenario::parse_ssh_address`.
TargetOption parse_target_option(const std::string& text);

}  // namespace tether::app
