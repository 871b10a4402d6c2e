#include "command_line.h"

#include "mission_file.h"
#include "task_arguments.h"

#include <sstream>
#include <utility>

#include <CLI/CLI.hpp>

#include <tether/base/version.h>

namespace tether::sut {
namespace {

constexpr const char* kDescription =
    "The paper's tasks as a program for the target: connects to Tether's coordinator and flies.";

constexpr const char* kExamples = R"(
Examples:
  tether-sut face_anchor --anchor blue_box
  tether-sut face_anchor --anchor blue_box --precision-deg 1 --yaw-rate-deg-s 30
  tether-sut relative_position --anchor blue_box --address 192.168.1.10:4810
  tether-sut move_forward --anchor blue_box --speed-m-s 0.3
  TETHER_CLOCK='cpu*20' tether-sut closed_path --anchor blue_box --distance-m 1
  tether-sut sensor_characterization --sensor camera --acquisitions 100
  tether-sut mission missions/look_around.toml

Environment (set by `tether run` for the SUT that it starts):
  TETHER_ADDRESS  the coordinator, host:port
  TETHER_TOKEN    the run's token, as the coordinator prints it
  TETHER_UAV      which UAV to fly; may be empty if there is only one
  TETHER_CLOCK    wall, cpu, or cpu*FACTOR for a virtual target FACTOR times slower

Exit codes: 0 the goal was reached; 1 it was not; 2 wrong use; 3 set-up or link failed.)";

void add_link_options(CLI::App& app, CommandLine& line) {
  app.add_option("--address", line.address,
                 "The coordinator, host:port (overrides TETHER_ADDRESS)");
  app.add_option("--uav", line.uav, "Which UAV to fly (overrides TETHER_UAV)");
  app.add_option("--clock", line.clock, "wall, cpu or cpu*FACTOR (overrides TETHER_CLOCK)");
}

CLI::App* add_subcommand(CLI::App& app, std::string_view name, std::string_view description,
                         CommandLine& line) {
  CLI::App* command = app.add_subcommand(std::string(name), std::string(description));
  add_link_options(*command, line);
  command->footer(kExamples);
  return command;
}

/// CLI11's own words for --help and --version; one line for a mistake.
Refusal refusal(const CLI::App& app, const CLI::ParseError& error) {
  if (error.get_exit_code() == 0) {
    std::ostringstream out;
    app.exit(error, out, out);
    return {0, out.str()};
  }
  return {2, "tether-sut: " + std::string(error.what()) + " (see tether-sut --help)\n"};
}

}  // namespace

std::variant<CommandLine, Refusal> parse_command_line(int argc, const char* const* argv) {
  CommandLine line;
  const auto tasks = all_task_arguments();
  CLI::App app(kDescription, "tether-sut");
  app.set_version_flag("--version", "tether-sut " + std::string(version()));
  app.footer(kExamples);
  app.require_subcommand(1);
  for (const auto& task : tasks) {
    task->add_to(*add_subcommand(app, task->name(), task->description(), line));
  }
  std::string mission_file;
  CLI::App* mission =
      add_subcommand(app, "mission", "Fly the tasks of a file, one after the other", line);
  mission->add_option("file,--file", mission_file, "The mission file (TOML)")->required();

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return refusal(app, error);
  }
  if (mission->parsed()) {
    Result<Mission> loaded = load_mission(mission_file);
    if (!loaded) {
      return Refusal{2, "tether-sut: " + loaded.failure().message + "\n"};
    }
    line.mission = std::move(loaded).value();
    return line;
  }
  for (const auto& task : tasks) {
    if (app.got_subcommand(std::string(task->name()))) {
      line.mission.tasks = {task->spec()};
    }
  }
  return line;
}

}  // namespace tether::sut
