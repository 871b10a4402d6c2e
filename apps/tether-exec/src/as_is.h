#pragma once

#include <string>
#include <vector>

namespace tether::exec {

/// The library to preload, where this program is installed or built. Throws std::runtime_error if
/// it is missing.
std::string library_as_is();

/// Becomes a program that knows nothing of Tether, with the library preloaded that makes its
/// clocks, waits and ports those of the run. Returns only if that fails: a line for the user.
std::string become_as_is(const std::vector<std::string>& command);

}  // namespace tether::exec
