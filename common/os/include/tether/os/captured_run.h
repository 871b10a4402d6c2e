#pragma once

#include <stop_token>
#include <string>
#include <vector>

#include <tether/base/time.h>

namespace tether::os {

/// The result of a program.
struct Captured {
  int code = -1;           ///< exit code; 128 + signal if a signal ended it
  bool timed_out = false;  ///< it was ended at the limit, or because of a stop
  std::string out;
  std::string err;
  Duration wall{0};  ///< from its start to its end
};

/// Runs a program with `input` as its standard input until it exits. Its streams are only in
/// memory. Ends it after `limit`, or when a stop is requested.
/// @throws Error(kSetup) if it cannot be started.
Captured run_captured(const std::vector<std::string>& arguments, const std::string& input,
                      Duration limit, const std::stop_token& stop = {});

}  // namespace tether::os
