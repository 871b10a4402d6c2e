#pragma once

#include "system.h"

#include <string>

namespace tether::devices {

/// Why no images can be had of the Video4Linux device at `path`, and what to do: "busy: another
/// program …". Asks the driver itself, after OpenCV, which does not say why.
std::string video4linux_fault(System& system, const std::string& path);

}  // namespace tether::devices
