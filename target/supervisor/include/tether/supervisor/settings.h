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
  std::vector<std::string> command{};  ///< empty if `members` > 0
  /// Socket of the group to which the command belongs, or that starts `members` commands. Empty:
  /// the command is alone.
  std::string group{};
  int members = 0;  ///< 0: this process has a command
  FreezerChoice freezer = FreezerChoice::kAuto;
  bool verbose = false;  ///< not with a group's command, nor `freezer`
  link::Address coordinator{};
  std::string token{};
  std::string uav{};    ///< empty: the one that the program names, or the only one
  double factor = 1.0;  ///< of the wall clock
};

}  // namespace tether::supervisor
