#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tether/supervisor/settings.h>

namespace tether::exec {

/// A text to print instead of running anything.
struct Notice {
  std::string text;
  int exit_code = 0;  ///< 0: to stdout; 2: to stderr
};

/// `arguments` without the program's name.
struct Parsed {
  supervisor::Settings settings;
  std::optional<Notice> notice;
};
Parsed parse_command_line(const std::vector<std::string>& arguments);
/// Adds what TETHER_ADDRESS, TETHER_TOKEN, TETHER_UAV and TETHER_CLOCK say. Fails with kInvalid.
Status read_environment(supervisor::Settings& settings);

}  // namespace tether::exec
