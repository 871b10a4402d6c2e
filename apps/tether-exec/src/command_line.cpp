#include "command_line.h"

#include <cstddef>
#include <map>
#include <utility>

#include <tether/base/version.h>
#include <tether/client/simulated_vehicle.h>

namespace tether::exec {
namespace {

constexpr const char* kHelp =
    "Usage: tether-exec [OPTIONS] COMMAND [ARGUMENT]...\n"
    "\n"
    "Runs a program under test that has several threads or processes. Each call to the UAV waits\n"
    "only for its own reply. The whole program is stopped while the simulation catches up.\n"
    "`tether run` sets the environment: TETHER_ADDRESS, TETHER_TOKEN, TETHER_UAV and "
    "TETHER_CLOCK,\n"
    "which must be wall or wall*FACTOR.\n"
    "\n"
    "Options:\n"
    "  --freezer KIND  how to stop the program: cgroup (with a cgroup v2), signal (with SIGSTOP) "
    "or\n"
    "                  auto (the default: cgroup if the system allows it, otherwise signal)\n"
    "  --verbose       report the cost of stopping at the end\n"
    "  --help          print this help and exit\n"
    "  --version       print the version and exit\n"
    "\n"
    "Exit code: that of the program, or 128 + the signal that ended it. 2: wrong use. 3: set-up\n"
    "failed.\n"
    "\n"
    "Examples:\n"
    "  tether-exec ./my-uav-program --config flight.yaml\n"
    "  tether-exec --freezer signal --verbose python3 fly.py\n"
    "In a scenario file:\n"
    "  command = [\"./my-uav-program\"]\n"
    "  concurrent = true\n";

/// Returns what is wrong with the value; empty if nothing is.
std::string set(supervisor::Settings& settings, const std::string& freezer) {
  const std::map<std::string, supervisor::FreezerChoice> choices = {
      {"auto", supervisor::FreezerChoice::kAuto},
      {"cgroup", supervisor::FreezerChoice::kCgroup},
      {"signal", supervisor::FreezerChoice::kSignal}};
  const auto found = choices.find(freezer);
  if (found == choices.end())
    return "invalid value '" + freezer + "' of --freezer. Use auto, cgroup or signal";
  settings.freezer = found->second;
  return "";
}

Parsed wrong_use(const std::string& what) {
  return {{}, Notice{"tether-exec: " + what + " (see tether-exec --help)\n", 2}};
}

}  // namespace

Parsed parse_command_line(const std::vector<std::string>& arguments) {
  Parsed parsed;
  std::size_t i = 0;
  for (; i < arguments.size() && arguments[i].rfind('-', 0) == 0; ++i) {
    const std::string& option = arguments[i];
    std::string error;
    if (option == "--") {
      ++i;
      break;
    }
    if (option == "--help" || option == "-h") return {{}, Notice{kHelp, 0}};
    if (option == "--version")
      return {{}, Notice{"tether-exec " + std::string(version()) + "\n", 0}};
    if (option == "--verbose") {
      parsed.settings.verbose = true;
    } else if (option == "--freezer") {
      error = i + 1 < arguments.size() ? set(parsed.settings, arguments[++i])
                                       : "--freezer needs a value. Use auto, cgroup or signal";
    } else if (option.rfind("--freezer=", 0) == 0) {
      error = set(parsed.settings, option.substr(std::string("--freezer=").size()));
    } else {
      error = "unknown option " + option;
    }
    if (!error.empty()) return wrong_use(error);
  }
  parsed.settings.command.assign(arguments.begin() + static_cast<std::ptrdiff_t>(i),
                                 arguments.end());
  if (parsed.settings.command.empty()) return wrong_use("no command to run");
  return parsed;
}

Status read_environment(supervisor::Settings& settings) {
  auto options = client::options_from_environment();
  if (!options) return options.failure();
  if (!options->exec_socket.empty()) {
    return Failure{Failure::Kind::kInvalid,
                   "TETHER_EXEC is set, so this process already runs under tether-exec"};
  }
  if (options->time->kind() != link::ClockKind::kWall) {
    return Failure{
        Failure::Kind::kInvalid,
        "TETHER_CLOCK must be wall or wall*FACTOR, because only the wall clock works for "
        "several threads"};
  }
  settings.coordinator = options->address;
  settings.token = options->token;
  settings.uav = options->uav;
  settings.factor = options->time->factor();
  return ok_status();
}

}  // namespace tether::exec
