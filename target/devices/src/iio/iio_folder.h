#pragma once

#include "clock.h"
#include "system.h"

#include <string>

#include <tether/base/result.h>

namespace tether::devices {

/// Where the kernel shows its IIO devices.
inline constexpr const char* kIioRoot = "/sys/bus/iio/devices";

/// The folder of an IIO device: `device` is a path, or "iio:NAME" with NAME "deviceN" or what the
/// `name` file of one of the devices below `root` says. Fails with kInvalid; the message is a line
/// that begins with `label`.
Result<std::string> find_iio_folder(System& system, Clock& clock, const std::string& label,
                                    const std::string& device, const std::string& root = kIioRoot);

/// What the driver calls the device in `folder`; empty if it does not say.
std::string iio_name(System& system, Clock& clock, const std::string& folder);

}  // namespace tether::devices
