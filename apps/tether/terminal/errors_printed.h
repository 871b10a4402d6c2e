#pragma once

#include <functional>

namespace tether::app {

/// Calls `command`, and prints the error with which it ends. @return the exit code.
int with_errors_printed(const std::function<int()>& command);

}  // namespace tether::app
