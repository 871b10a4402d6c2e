#pragma once

#include "freezer.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

#include <tether/base/result.h>

namespace tether::supervisor {

/// A program to start.
struct Command {
  std::vector<std::string> words;
  /// "NAME=VALUE"; none: the environment of this process.
  std::optional<std::vector<std::string>> environment{};
  /// Its working folder, and its standard input, output and errors; −1: those of this process.
  std::array<int, 4> descriptors{-1, -1, -1, -1};
};

/// Starts a command in a process group of its own, and in `cgroup` if there is one, with
/// TETHER_EXEC set to `socket`. A standard input that is a terminal becomes /dev/null: a group in
/// the background could not read it. Returns the process, which dies with this one.
///
/// Fails with kInvalid, naming the command, if it is not there or cannot be executed.
Result<pid_t> start_command(const Command& command, const std::string& socket,
                            const std::optional<Cgroup>& cgroup);

}  // namespace tether::supervisor
