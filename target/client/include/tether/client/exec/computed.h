#pragma once

#include <map>
#include <string>
#include <string_view>

#include <tether/base/time.h>

namespace tether::client {

/// What each part of a program that knows nothing of Tether has computed: CPU time by name.
using Computed = std::map<std::string, Duration>;

/// As the details of its end: {"computed_s": {"camera.py": 1.25}}. Without parts of less than 10
/// ms.
std::string details_of(const Computed& computed);

/// What a process is called: its program, and a script that it runs, by the last parts of their
/// paths. `arguments`: as in /proc/PID/cmdline.
std::string process_name(std::string_view arguments);

}  // namespace tether::client
