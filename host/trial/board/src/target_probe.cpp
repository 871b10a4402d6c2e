#include "board_scripts.h"

#include <string>

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/board/target_probe.h>
#include <tether/os/child_process.h>

namespace tether::board {

namespace {

constexpr Duration kProbeLimit = std::chrono::seconds(10);

std::string script_of(ProbeDepth depth) {
  return fmt::format("depth={}\n{}", depth == ProbeDepth::kBrief ? "brief" : "full", kTargetProbe);
}

}  // namespace

record::Readings probe_here(ProbeDepth depth) try {
  return parse_readings(os::run_captured({"sh"}, script_of(depth), kProbeLimit).out);
} catch (const Error& e) {
  throw Error(e.code(), fmt::format("cannot read the state of this machine: {}", e.what()));
}

record::Readings probe_board(const SshConnection& connection, ProbeDepth depth) {
  return parse_readings(connection.run(script_of(depth), kProbeLimit, {}, true).out);
}

}  // namespace tether::board
