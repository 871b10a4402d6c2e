#pragma once

#include <filesystem>
#include <string>
#include <variant>

#include <tether/scenario/target.h>

namespace tether::runner {

/// The user starts the SUT, on any machine: `--target wait`.
struct WaitForSut {
  friend bool operator==(const WaitForSut&, const WaitForSut&) = default;
};

/// Where SUTs run instead of on their condition's computers: nowhere else, on the target of a file,
/// on a board, or where the user starts them.
using TargetChoice =
    std::variant<std::monostate, std::filesystem::path, scenario::SshAddress, WaitForSut>;

/// As users write it: "" is none, "wait" is WaitForSut, a text with "://" is an address, and any
/// other text is a name or file. Reads no file.
/// @throws Error(kUsage) as `scenario::parse_ssh_address`.
TargetChoice parse_target_choice(const std::string& text);
/// The inverse, for files whose path has a '/'.
std::string to_text(const TargetChoice& choice);

}  // namespace tether::runner
