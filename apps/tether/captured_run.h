#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <tether/base/time.h>

namespace tether::app {

/// What a program that has run left.
struct Captured {
  int code = -1;           ///< exit code; 128 + signal where a signal ended it
  bool timed_out = false;  ///< it was ended because it took too long
  std::string out;
  std::string err;
  Duration wall{0};  ///< from its start to its end
};

/// Runs a program to its end with `input` as its standard input. Its streams are in memory
/// only. Ends it when the user interrupts, unless it is part of leaving.
/// @throws Error(kSetup) when it cannot be started.
Captured run_captured(const std::vector<std::string>& arguments, const std::string& input,
                      Duration limit, bool is_leaving = false);

/// The whole file; empty where there is none.
std::string read_whole(const std::filesystem::path& file);
/// The last line that is not blank, without what is around it; empty: none.
std::string last_line(const std::string& text);

}  // namespace tether::app
