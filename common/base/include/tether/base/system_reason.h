#pragma once

#include <string>

namespace tether {

/// What the system says of `error_number` (an errno), and what to do where a process may open no
/// more files. Thread-safe.
std::string reason_of(int error_number);

/// "signal 9 (Killed)". Not thread-safe.
std::string name_of_signal(int signal);

}  // namespace tether
