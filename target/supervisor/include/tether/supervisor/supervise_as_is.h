#pragma once

#include <string>
#include <vector>

#include <tether/supervisor/supervise.h>

namespace tether::supervisor {

/// Runs a program of several processes that know nothing of Tether, with `library` preloaded: they
/// share one execution time, one core of this machine, and the UAV's devices (docs/guide/as-is.md).
/// Returns the program's exit code, or 3 if there is no run to join; dies of the signal of which
/// the program died.
int supervise_as_is(const std::vector<std::string>& command, const std::string& library,
                    const Say& say);

}  // namespace tether::supervisor
