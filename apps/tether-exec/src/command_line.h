#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tether/supervisor/supervise.h>

namespace tether::exec {

/// A text to print instead of running a program.
struct Notice {
  std::string text;
  int exit_code = 0;  ///< 0: to stdout; 2: to stderr
};

/// A parsed command line.
struct Parsed {
  supervisor::Settings settings;
  std::optional<Notice> notice;
  bool is_as_is = false;           ///< its command knows nothing of Tether (as_is.h)
  bool has_all_processes = false;  ///< as_is, with all processes that it starts
};
/// @param arguments without the program's name.
Parsed parse_command_line(const std::vector<std::string>& arguments);
/// Whether TETHER_CLOCK is the wall clock, also with a factor.
bool is_wall_clock();
/// Adds the settings in TETHER_ADDRESS, TETHER_TOKEN, TETHER_UAV and TETHER_CLOCK. Fails with
/// kInvalid.
Status read_environment(supervisor::Settings& settings);

}  // namespace tether::exec
