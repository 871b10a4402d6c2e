#pragma once

#include <functional>
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

// Runs a program of several threads or processes, and stops all of it while the simulation catches
// up (docs/guide/threads.md).

/// Receives each message to the user, without a final newline. Messages have one line, except the
/// statistics of `Settings::verbose`.
using Say = std::function<void(const std::string&)>;

/// Runs the command until it ends, stops it when the coordinator requires it, and ends all of its
/// processes. Returns the command's exit code, 128 + the signal that ended it, 2 if it cannot be
/// started, or 3 if the set-up failed or the command could not be stopped.
///
/// A group's process does this for the commands that others give to it, and returns 0 once they
/// have ended. A group's command runs there, and its exit code is returned here.
///
/// Changes the signal mask, the priority and TETHER_EXEC of the whole process, which must have one
/// thread and no children.
int supervise(const Settings& settings, const Say& say);

}  // namespace tether::supervisor
