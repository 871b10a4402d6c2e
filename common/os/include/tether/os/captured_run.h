#pragma once

#include <stop_token>
#include <string>
#include <vector>

#include <tether/base/time.h>

namespace tether::os {

/// What a program that has run left.
struct Captured {
  int code = -1;           ///< exit code; 128 + signal where a signal ended it
  bool timed_out = false;  ///< it was ended because it took too long
  std::string out;
  std::string err;
  Duration wall{0};  ///< from its start to its end
};

/// Runs a program to its end with `input` as its standard input. Its streams are in memory
/// only. Ends it early when a stop is requested.
/// @throws Error(kSetup) when it cannot be started.
Captured run_captured(const std::vector<std::string>& arguments, const std::string& input,
                      Duration limit, const std::stop_token& stop = {});

}  // namespace tether::os
