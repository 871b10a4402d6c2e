#pragma once

#include <functional>
#include <string>

#include <tether/supervisor/settings.h>

/// Runs a program of several threads or processes under test, so that all of it is stopped whenever
/// the simulation has to catch up (docs/guide/threads.md).
namespace tether::supervisor {

/// Receives each message for a person, without the last line's end. Only `Settings::verbose` makes
/// one of several lines.
using Say = std::function<void(const std::string&)>;

/// Runs the command until it ends, stops it when the coordinator requires it, and ends all of its
/// processes. Returns the command's exit code, 128 + the signal that ended it, 2 if it cannot be
/// started, or 3 if the set-up failed or the command could not be stopped.
///
/// Changes the whole process: its signal mask, its priority, and TETHER_EXEC. It must have one
/// thread and no children.
int supervise(const Settings& settings, const Say& say);

}  // namespace tether::supervisor
