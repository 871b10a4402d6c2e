#pragma once

#include <string>

namespace tether {

/// What the system says of `error_number` (an errno), and what to do where a process may open no
/// more files. Thread-safe.
std::string reason_of(int error_number);

}  // namespace tether
