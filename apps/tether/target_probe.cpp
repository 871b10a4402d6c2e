#include "target_probe.h"

#include "board_scripts.h"

#include <string>

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/experiment/target_readings.h>
#include <tether/os/captured_run.h>

namespace tether::app {

namespace {

constexpr Duration kLimit = std::chrono::seconds(10);

std::string script_of(ProbeDepth depth) {
  return fmt::format("depth={}\n{}", depth == ProbeDepth::kBrief ? "brief" : "full", kTargetProbe);
}

}  // namespace

record::Readings probe_here(ProbeDepth depth) try {
  return experiment::parse_readings(os::run_captured({"sh"}, script_of(depth), kLimit, true).out);
} catch (const Error& e) {
  throw Error(e.code(), fmt::format("the state of this machine cannot be read: {}", e.what()));
}

record::Readings probe_board(const SshConnection& connection, ProbeDepth depth) {
  return experiment::parse_readings(connection.run(script_of(depth), kLimit, {}, true).out);
}

}  // namespace tether::app
