#pragma once

#include <string>
#include <vector>

#include <tether/base/result.h>
#include <tether/base/time.h>
#include <tether/link/channel.h>

namespace tether::supervisor {

enum class FreezerChoice { kAuto, kCgroup, kSignal };

/// What the command line and the environment say.
struct Settings {
  std::vector<std::string> command;
  FreezerChoice freezer = FreezerChoice::kAuto;
  bool verbose = false;
  link::Address coordinator;
  std::string token;
  std::string uav;      ///< empty: as the program says, or the only one
  double factor = 1.0;  ///< of the wall clock
};

}  // namespace tether::supervisor
