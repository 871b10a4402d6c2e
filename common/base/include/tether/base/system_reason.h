#pragma once

#include <string>

namespace tether {

/// The system's text for `error_number` (an errno), with advice if the limit of open files is
/// reached. Thread-safe.
std::string reason_of(int error_number);

/// "signal 9 (Killed)". Not thread-safe.
std::string name_of_signal(int signal);

}  // namespace tether
