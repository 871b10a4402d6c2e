#pragma once

#include <string>
#include <vector>

#include <tether/base/result.h>
#include <tether/base/time.h>
#include <tether/link/channel.h>

namespace tether::supervisor {

enum class FreezerChoice { kAuto, kCgroup, kSignal };

/// Settings from the command line and the environment.
struct Settings {
  std::vector<std::string> command;
  FreezerChoice freezer = FreezerChoice::kAuto;
  bool verbose = false;
  link::Address coordinator;
  std::string token;
  std::string uav;      ///< empty: the one that the program names, or the only one
  double factor = 1.0;  ///< of the wall clock
};

}  // namespace tether::supervisor
