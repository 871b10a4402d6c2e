#pragma once

#include <string>
#include <vector>

namespace tether::exec {

/// Becomes a program that knows nothing of Tether, with the library preloaded that makes its
/// clocks, waits and ports those of the run. Returns only if that fails: a line for the user.
std::string become_as_is(const std::vector<std::string>& command);

}  // namespace tether::exec
