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
    "for its own reply only. The whole program is stopped while the simulation catches up.\n"
    "`tether run` sets the environment it needs (TETHER_ADDRESS, TETHER_TOKEN, and\n"
    "TETHER_UAV and TETHER_CLOCK where they matter); TETHER_CLOCK is wall or wall*FACTOR.\n"
    "\n"
    "Options:\n"
    "  --freezer KIND  how the program is stopped: cgroup (a cgroup v2 of its own), signal "
    "(SIGSTOP\n"
    "                  to its process group) or auto (the default: cgroup where the system allows "
    "it)\n"
    "  --verbose       say at the end what stopping has cost\n"
    "  --help          print this and exit\n"
    "  --version       print the version and exit\n"
    "\n"
    "Exit code: the program's own, or 128 + the signal that ended it. 2: wrong use. 3: the set-up\n"
    "failed.\n"
    "\n"
    "Examples:\n"
    "  tether-exec ./my-uav-program --config flight.yaml\n"
    "  tether-exec --freezer signal --verbose python3 fly.py\n"
    "In a scenario:\n"
    "  command = [\"./my-uav-program\"]\n"
    "  concurrent = true\n";

/// What is wrong with it; empty: nothing.
std::string set(supervisor::Settings& settings, const std::string& freezer) {
  const std::map<std::string, supervisor::FreezerChoice> choices = {
      {"auto", supervisor::FreezerChoice::kAuto},
      {"cgroup", supervisor::FreezerChoice::kCgroup},
      {"signal", supervisor::FreezerChoice::kSignal}};
  const auto found = choices.find(freezer);
  if (found == choices.end()) {
    return "--freezer is '" + freezer + "'; allowed are auto, cgroup and signal";
  }
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
                                       : "--freezer needs a value: auto, cgroup or signal";
    } else if (option.rfind("--freezer=", 0) == 0) {
      error = set(parsed.settings, option.substr(std::string("--freezer=").size()));
    } else {
      error = "there is no option " + option;
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
                   "TETHER_EXEC is set: this already runs under a tether-exec"};
  }
  if (options->time->kind() != link::ClockKind::kWall) {
    return Failure{Failure::Kind::kInvalid,
                   "TETHER_CLOCK is neither wall nor wall*FACTOR: several threads share one time "
                   "line, and only the wall clock is one"};
  }
  settings.coordinator = options->address;
  settings.token = options->token;
  settings.uav = options->uav;
  settings.factor = options->time->factor();
  return ok_status();
}

}  // namespace tether::exec
