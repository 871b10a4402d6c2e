#include "command_line.h"

#include "device_arguments.h"
#include "measuring_arguments.h"
#include "mission_file.h"
#include "task_arguments.h"

#include <memory>
#include <sstream>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include <tether/base/version.h>

namespace tether::sut {
namespace {

constexpr const char* kDescription =
    "The paper's tasks as a program for the target: connects to Tether's coordinator and flies, or "
    "runs them on real sensors (--rig, --camera DEVICE, ...).";

constexpr const char* kExamples = R"(
Examples:
  tether-sut face_anchor --anchor blue_box
  tether-sut face_anchor --anchor blue_box --precision-deg 1 --yaw-rate-deg-s 30
  tether-sut relative_position --anchor blue_box --address 192.168.1.10:4810
  tether-sut move_forward --anchor blue_box --speed-m-s 0.3
  TETHER_CLOCK='cpu*20' tether-sut closed_path --anchor blue_box --distance-m 1
  tether-sut sensor_characterization --sensor camera --acquisitions 100
  tether-sut mission data/missions/look_around.toml
  tether-sut relative_position --anchor blue_box --rig data/rigs/bench.toml --camera /dev/video0
  tether-sut characterize --camera /dev/video0 --range iio:vl53l0x --out bench.toml
  tether-sut calibrate --out board.toml
  tether-sut calibrate --against board.toml --write-target my_board.toml

Environment (set by `tether run` for the SUT that it starts):
  TETHER_ADDRESS  the coordinator, host:port
  TETHER_TOKEN    the run's token, as the coordinator prints it
  TETHER_UAV      which UAV to fly; may be empty if there is only one
  TETHER_CLOCK    wall, cpu, or cpu*FACTOR for a virtual target FACTOR times slower
  TETHER_OUT      the run's folder; files to write are relative to it

Exit codes: 0 the goal was reached; 1 it was not; 2 wrong use; 3 set-up or link failed.)";

void add_link_options(CLI::App& app, CommandLine& line) {
  app.add_option("--address", line.address,
                 "The coordinator, host:port (overrides TETHER_ADDRESS)");
  app.add_option("--uav", line.uav, "Which UAV to fly (overrides TETHER_UAV)");
  app.add_option("--clock", line.clock, "wall, cpu or cpu*FACTOR (overrides TETHER_CLOCK)");
}

/// What is written while parsing.
struct Words {
  CommandLine line;
  DeviceArguments devices;
  CharacterizeOptions characterize;
  CalibrateOptions calibrate;
  std::string mission_file;
};

/// `define` adds the subcommand's own options.
template <class Define>
CLI::App* add_subcommand(CLI::App& app, std::string_view name, std::string_view description,
                         Words& words, Define define) {
  CLI::App* command = app.add_subcommand(std::string(name), std::string(description));
  define(*command);
  add_link_options(*command, words.line);
  add_device_options(*command, words.devices);
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

Refusal refusal(const std::string& what) {
  return {2, "tether-sut: " + what + "\n"};
}

using Tasks = std::vector<std::unique_ptr<TaskArguments>>;

void define_subcommands(CLI::App& app, const Tasks& tasks, Words& words) {
  for (const auto& task : tasks) {
    add_subcommand(app, task->name(), task->description(), words, [&](CLI::App& command) {
      task->add_to(command);
      if (task->name() == "relative_position") {
        add_real_row_options(command, words.line.real_row);
      }
    });
  }
  add_subcommand(app, "mission", "Fly the tasks of a file, one after the other", words,
                 [&](CLI::App& command) {
                   command.add_option("file,--file", words.mission_file, "The mission file (TOML)")
                       ->required();
                 });
  add_subcommand(app, "characterize", "Time each sensor's data, and write it as a profile", words,
                 [&](CLI::App& command) { add_characterize_options(command, words.characterize); });
  CLI::App* calibrate = app.add_subcommand(
      "calibrate", "Measure how fast this machine is; with --against, how much slower another");
  add_calibrate_options(*calibrate, words.calibrate);
  calibrate->footer(kExamples);
}

/// What is to be flown, of what was parsed.
Status take_mission(const CLI::App& app, const Tasks& tasks, Words& words) {
  if (app.got_subcommand("calibrate")) {
    words.line.calibrate = words.calibrate;
    return check(words.calibrate);
  }
  if (app.got_subcommand("characterize")) {
    words.line.characterize = words.characterize;
    return check(words.characterize);
  }
  if (app.got_subcommand("mission")) {
    Result<Mission> loaded = load_mission(words.mission_file);
    if (!loaded) {
      return loaded.failure();
    }
    words.line.mission = std::move(loaded).value();
    return ok_status();
  }
  for (const auto& task : tasks) {
    if (app.got_subcommand(std::string(task->name()))) {
      words.line.mission.tasks = {task->spec()};
      take_devices(words.line.mission.tasks.front(), words.devices);
    }
  }
  return ok_status();
}

/// Options that are about one of the two, a coordinator or real devices.
Status check_link(const CommandLine& line) {
  if (line.rig && (line.address || line.uav || line.clock)) {
    return Failure{Failure::Kind::kInvalid,
                   "--address, --uav and --clock are about a coordinator, and real devices have "
                   "none"};
  }
  if (!line.rig && is_given(line.real_row)) {
    return Failure{Failure::Kind::kInvalid,
                   "--true-roi-px and --keep-image are for real devices (--rig, --camera DEVICE)"};
  }
  return ok_status();
}

/// The words that CLI11 could parse, as one command.
std::variant<CommandLine, Refusal> understand(const CLI::App& app, const Tasks& tasks,
                                              Words& words) {
  if (const Status mission = take_mission(app, tasks, words); !mission) {
    return refusal(mission.failure().message);
  }
  Result<std::optional<devices::Rig>> rig = make_rig(words.devices, words.line.mission);
  if (!rig) {
    return refusal(rig.failure().message);
  }
  words.line.rig = std::move(rig).value();
  if (const Status link = check_link(words.line); !link) {
    return refusal(link.failure().message);
  }
  return std::move(words.line);
}

}  // namespace

std::variant<CommandLine, Refusal> parse_command_line(int argc, const char* const* argv) {
  Words words;
  const Tasks tasks = all_task_arguments();
  CLI::App app(kDescription, "tether-sut");
  app.set_version_flag("--version", "tether-sut " + std::string(version()));
  app.footer(kExamples);
  app.require_subcommand(1);
  define_subcommands(app, tasks, words);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return refusal(app, error);
  }
  return understand(app, tasks, words);
}

}  // namespace tether::sut
