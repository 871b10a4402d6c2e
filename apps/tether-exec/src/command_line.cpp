#include "command_line.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <map>
#include <utility>

#include <tether/base/version.h>
#include <tether/client/simulated_vehicle.h>

namespace tether::exec {
namespace {

constexpr const char* kHelp =
    "Usage: tether-exec [OPTIONS] COMMAND [ARGUMENT]...\n"
    "       tether-exec [OPTIONS] --group SOCKET --members N\n"
    "       tether-exec --group SOCKET COMMAND [ARGUMENT]...\n"
    "\n"
    "Runs a program under test that has several threads or processes. Each call to the UAV waits\n"
    "only for its own reply. The whole program is stopped while the simulation catches up.\n"
    "`tether run` sets the environment: TETHER_ADDRESS, TETHER_TOKEN, TETHER_UAV and "
    "TETHER_CLOCK,\n"
    "which must be wall or wall*FACTOR.\n"
    "\n"
    "The programs of several UAVs on one board form a group. They have one execution time and are\n"
    "stopped together. One process has --members; one for each program has --group and the\n"
    "program's command, and ends as the program does.\n"
    "\n"
    "Options:\n"
    "  --freezer KIND  how to stop the program: cgroup (with a cgroup v2), signal (with SIGSTOP) "
    "or\n"
    "                  auto (the default: cgroup if the system allows it, otherwise signal)\n"
    "  --group SOCKET  path of the group's socket, which the process with --members creates\n"
    "  --members N     number of programs in the group; it begins when all have connected\n"
    "  --verbose       report the cost of stopping at the end\n"
    "  --help          print this help and exit\n"
    "  --version       print the version and exit\n"
    "\n"
    "Exit code: that of the program, or 128 + the signal that ended it; with --members, 0. 2: "
    "wrong\n"
    "use. 3: set-up failed.\n"
    "\n"
    "Examples:\n"
    "  tether-exec ./my-uav-program --config flight.yaml\n"
    "  tether-exec --freezer signal --verbose python3 fly.py\n"
    "  tether-exec --group /tmp/board --members 2 &\n"
    "  TETHER_UAV=uav1 tether-exec --group /tmp/board ./my-uav-program\n"
    "In a scenario file:\n"
    "  command = [\"./my-uav-program\"]\n"
    "  concurrent = true\n";

/// Each sets a value, and returns what is wrong with it; empty if nothing is.
std::string set_freezer(supervisor::Settings& settings, const std::string& freezer) {
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

std::string set_group(supervisor::Settings& settings, const std::string& socket) {
  settings.group = socket;
  return "";
}

std::string set_members(supervisor::Settings& settings, const std::string& number) {
  constexpr int kMost = 1024;
  const auto [end, error] =
      std::from_chars(number.data(), number.data() + number.size(), settings.members);
  const bool is_number = error == std::errc() && end == number.data() + number.size();
  if (is_number && settings.members >= 1 && settings.members <= kMost) return "";
  return "invalid value '" + number + "' of --members. Use a number from 1 to " +
         std::to_string(kMost);
}

struct ValueOption {
  std::string name;
  std::string value;  ///< what it needs
  std::string (*set)(supervisor::Settings&, const std::string&);
};
const std::array kValueOptions = {
    ValueOption{"--freezer", "a value. Use auto, cgroup or signal", &set_freezer},
    ValueOption{"--group", "the path of a socket", &set_group},
    ValueOption{"--members", "a number", &set_members}};

Parsed wrong_use(const std::string& what) {
  return {{}, Notice{"tether-exec: " + what + " (see tether-exec --help)\n", 2}};
}

/// Which options go together; empty if these do.
std::string conflict(const supervisor::Settings& settings, bool has_own_options) {
  if (settings.members > 0) {
    if (settings.group.empty()) return "--members needs --group SOCKET";
    if (settings.command.empty()) return "";
    return "--members starts no command itself: give it to another tether-exec with --group";
  }
  if (settings.command.empty()) return "no command to run";
  if (!settings.group.empty() && has_own_options)
    return "--freezer and --verbose belong to the tether-exec with --members";
  return "";
}

}  // namespace

Parsed parse_command_line(const std::vector<std::string>& arguments) {
  Parsed parsed;
  bool has_own_options = false;  // of a process that stops programs
  std::size_t i = 0;
  for (; i < arguments.size() && arguments[i].rfind('-', 0) == 0; ++i) {
    const std::string& option = arguments[i];
    if (option == "--") {
      ++i;
      break;
    }
    if (option == "--help" || option == "-h") return {{}, Notice{kHelp, 0}};
    if (option == "--version")
      return {{}, Notice{"tether-exec " + std::string(version()) + "\n", 0}};
    if (option == "--verbose") {
      parsed.settings.verbose = has_own_options = true;
      continue;
    }
    const std::string name = option.substr(0, option.find('='));
    const auto found = std::ranges::find(kValueOptions, name, &ValueOption::name);
    if (found == kValueOptions.end()) return wrong_use("unknown option " + option);
    std::string value;
    if (name != option)
      value = option.substr(name.size() + 1);
    else if (i + 1 < arguments.size())
      value = arguments[++i];
    if (value.empty()) return wrong_use(name + " needs " + found->value);
    const std::string error = found->set(parsed.settings, value);
    if (!error.empty()) return wrong_use(error);
    has_own_options = has_own_options || name == "--freezer";
  }
  parsed.settings.command.assign(arguments.begin() + static_cast<std::ptrdiff_t>(i),
                                 arguments.end());
  const std::string wrong = conflict(parsed.settings, has_own_options);
  if (!wrong.empty()) return wrong_use(wrong);
  return parsed;
}

Status read_environment(supervisor::Settings& settings) {
  auto options = client::options_from_environment();
  if (!options) return options.failure();
  if (!options->exec_socket.empty()) {
    return Failure{Failure::Kind::kInvalid,
                   "TETHER_EXEC is set, so this process already runs under tether-exec"};
  }
  if (options->time->clock().kind != computer::ClockKind::kWall) {
    return Failure{
        Failure::Kind::kInvalid,
        "TETHER_CLOCK must be wall or wall*FACTOR, because only the wall clock works for "
        "several threads"};
  }
  settings.coordinator = options->address;
  settings.token = options->token;
  settings.uav = options->uav;
  settings.factor = options->time->clock().factor;
  return ok_status();
}

}  // namespace tether::exec
