#pragma once

#include "freezer.h"

#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

#include <tether/base/result.h>

namespace tether::supervisor {

/// Starts a command in a process group of its own, and in `cgroup` if there is one, with
/// TETHER_EXEC set to `socket`. A standard input that is a terminal becomes /dev/null: a group in
/// the background could not read it. Returns the process, which dies with this one.
///
/// Fails with kInvalid, naming the command, if it is not there or cannot be executed.
Result<pid_t> start_command(const std::vector<std::string>& command, const std::string& socket,
                            const std::optional<Cgroup>& cgroup);

}  // namespace tether::supervisor
