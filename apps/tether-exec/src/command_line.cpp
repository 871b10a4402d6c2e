#include "command_line.h"

#include "shared/command.h"
#include "shared/help.h"
#include "shared/manual.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <functional>
#include <map>
#include <stdexcept>

#include <CLI/CLI.hpp>
#include <unistd.h>

#include <tether/base/version.h>
#include <tether/client/simulated_vehicle.h>
#include <tether/computer/clock.h>
#include <tether/os/terminal.h>

namespace tether::exec {
namespace {

constexpr const char* kDescription =
    R"(Runs a program under test that has several threads or processes. Each call to the UAV waits only
for its own reply. The whole program is stopped while the simulation catches up. `tether run` sets
the environment: TETHER_ADDRESS, TETHER_TOKEN, TETHER_UAV and TETHER_CLOCK, which must be wall or
wall*FACTOR.

The programs of several UAVs on one board form a group. They have one execution time and are stopped
together. One process has --members; one for each program has only --group and the program's
command, and ends as the program does.)";

constexpr const char* kFooter =
    R"(Exit codes: that of the program, or 128 plus the number of the signal that ended it; with
--members, 0 when all programs of the group have ended. 2: wrong use. 3: set-up failed.

Examples:
  tether-exec ./my-uav-program --config flight.yaml
  tether-exec --freezer signal --verbose python3 fly.py
  tether-exec --as-is python3 companion.py
  tether-exec --as-is --all-processes ./start_ros.sh
  tether-exec --group /tmp/board --members 2 &
  TETHER_UAV=uav1 tether-exec --group /tmp/board ./my-uav-program

In a scenario file:
  command = ["./my-uav-program"]
  concurrent = true)";

void set_freezer(supervisor::Settings& settings, const std::string& freezer) {
  static const std::map<std::string, supervisor::FreezerChoice> kChoices = {
      {"auto", supervisor::FreezerChoice::kAuto},
      {"cgroup", supervisor::FreezerChoice::kCgroup},
      {"signal", supervisor::FreezerChoice::kSignal}};
  const auto found = kChoices.find(freezer);
  if (found == kChoices.end()) throw std::invalid_argument("auto, cgroup or signal");
  settings.freezer = found->second;
}

void set_members(supervisor::Settings& settings, const std::string& number) {
  constexpr int kMost = 1024;
  const auto [end, error] =
      std::from_chars(number.data(), number.data() + number.size(), settings.members);
  const bool is_number = error == std::errc() && end == number.data() + number.size();
  if (!is_number || settings.members < 1 || settings.members > kMost)
    throw std::invalid_argument("a number from 1 to " + std::to_string(kMost));
}

/// A function throws what could be used instead of the value.
struct Row {
  app::Option option;
  const char* needs = "";  ///< what is missing without a value
};

std::vector<Row> rows_of(Parsed& parsed) {
  supervisor::Settings& settings = parsed.settings;
  return {
      {{"--as-is",
        "Fly a program that knows nothing of Tether: its clocks and waits follow its execution "
        "time, and its UDP ports are those of the flight controller",
        &parsed.is_as_is}},
      {{"--all-processes",
        "With --as-is: so do all processes that the program starts. With the clock cpu, they share "
        "one core of this machine; with the clock wall, they are stopped together",
        &parsed.has_all_processes}},
      {{"--freezer auto|cgroup|signal",
        "How to stop the program: cgroup (with a cgroup v2), signal (with SIGSTOP) or auto "
        "(cgroup if the system allows it, otherwise signal) [auto]",
        [&](const std::string& word) { set_freezer(settings, word); }},
       "a value. Use auto, cgroup or signal"},
      {{"--group SOCKET",
        "Path of the group's socket, which the process with --members creates; the others wait "
        "up to 10 seconds for it",
        [&](const std::string& path) { settings.group = path; }},
       "the path of a socket"},
      {{"--members N",
        "Number of programs in the group, from 1 to 1024; it begins when all have connected",
        [&](const std::string& number) { set_members(settings, number); }},
       "a number"},
      {{"--verbose", "Report the cost of stopping at the end", &settings.verbose}}};
}

/// For arguments that ask for a text, and run no program.
std::optional<std::string> asked_text(const std::vector<std::string>& arguments,
                                      const std::vector<Row>& rows) {
  CLI::App program(kDescription, "tether-exec");
  program.footer(kFooter);
  program.set_version_flag("--version", "tether-exec " + std::string(version()));
  program.formatter(app::help_format(os::text_columns(STDOUT_FILENO)));
  for (const Row& row : rows) app::add_options(program, {row.option});
  std::string command;
  std::vector<std::string> words;
  app::add_options(program, {{"COMMAND", "Program to run; none with --members", &command},
                             {"ARGUMENT", "Its arguments", &words}});
  if (arguments.front() == "--help" || arguments.front() == "-h") return program.help();
  if (arguments.front() == "--version") return program.version() + "\n";
  return app::asked_manual_page(program, arguments);
}

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
  const std::vector<Row> rows = rows_of(parsed);
  auto at = arguments.begin();
  for (; at != arguments.end() && at->starts_with('-'); ++at) {
    const std::string option = *at;
    if (option == "--") {
      ++at;
      break;
    }
    const std::string name = option.substr(0, option.find('='));
    const auto row = std::ranges::find(rows, name, [](const Row& r) { return key_of(r.option); });
    if (row == rows.end()) {
      const auto text = asked_text({at, arguments.end()}, rows);
      return text ? Parsed{{}, Notice{*text, 0}} : wrong_use("unknown option " + option);
    }
    has_own_options |= name == "--freezer" || name == "--verbose";
    if (auto* const* flag = std::get_if<bool*>(&row->option.destination)) {
      if (name != option) return wrong_use("unknown option " + option);
      **flag = true;
      continue;
    }
    std::string value;
    if (name != option)
      value = option.substr(name.size() + 1);
    else if (at + 1 != arguments.end())
      value = *++at;
    if (value.empty()) return wrong_use(name + " needs " + row->needs);
    try {
      std::get<std::function<void(const std::string&)>>(row->option.destination)(value);
    } catch (const std::invalid_argument& allowed) {
      return wrong_use("invalid value '" + value + "' of " + name + ". Use " + allowed.what());
    }
  }
  parsed.settings.command.assign(at, arguments.end());
  std::string wrong = conflict(parsed.settings, has_own_options);
  if (parsed.has_all_processes && !parsed.is_as_is) wrong = "--all-processes needs --as-is";
  if (parsed.is_as_is && (has_own_options || !parsed.settings.group.empty()))
    wrong = "--as-is starts a program that nobody stops: use it without other options";
  if (!wrong.empty()) return wrong_use(wrong);
  return parsed;
}

bool is_wall_clock() {
  const char* const text = std::getenv("TETHER_CLOCK");
  const auto clock = computer::parse_clock(text == nullptr ? "wall" : text);
  return clock && clock->kind == computer::ClockKind::kWall;
}

Status read_environment(supervisor::Settings& settings) {
  auto options = client::options_from_environment();
  if (!options) return options.failure();
  if (!options->exec_socket.empty()) {
    return Failure{Failure::Kind::kInvalid,
                   "TETHER_EXEC is set, so this process already runs under tether-exec"};
  }
  if (options->time->clock().kind != computer::ClockKind::kWall) {
    return Failure{Failure::Kind::kInvalid,
                   "TETHER_CLOCK must be wall or wall*FACTOR, because only the wall clock works "
                   "for several threads"};
  }
  settings.coordinator = options->address;
  settings.token = options->token;
  settings.uav = options->uav;
  settings.factor = options->time->clock().factor;
  return ok_status();
}

}  // namespace tether::exec
