#pragma once

#include <tether/supervisor/settings.h>

#include <optional>
#include <string>
#include <vector>

namespace tether::exec {

/// A text to print instead of running anything.
struct Notice {
  std::string text;
  int exit_code = 0;  ///< 0: to stdout; 2: to stderr
};

/// `arguments` without the program's name.
struct Parsed {
  Settings settings;
  std::optional<Notice> notice;
};
Parsed parse_command_line(const std::vector<std::string>& arguments);
/// Adds what TETHER_ADDRESS, TETHER_TOKEN, TETHER_UAV and TETHER_CLOCK say. Fails with kInvalid.
Status read_environment(Settings& settings);

}  // namespace tether::exec
