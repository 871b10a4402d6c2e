#include "command_line.h"

#include "shared/command.h"
#include "shared/complaint.h"
#include "shared/completion.h"
#include "shared/help.h"
#include "shared/manual.h"
#include "shared/within.h"

#include <algorithm>
#include <map>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <unistd.h>

#include <tether/base/text.h>
#include <tether/base/units.h>
#include <tether/base/version.h>
#include <tether/calibration/characterize.h>
#include <tether/os/terminal.h>
#include <tether/rig/device_arguments.h>
#include <tether/rig/mission.h>

// The options of all commands; of this program, only this source includes CLI11. The options of
// tasks are made from rig::task_fields, the others are defined here. After CLI11 has parsed the
// arguments, understand() checks which options can be combined.

namespace tether::sut {
namespace {

using app::checked;
using app::Option;
using app::Options;
using app::range;
using app::required;

constexpr const char* kDescription =
    "Runs the tasks of the paper on the target: in simulation, connected to Tether's coordinator, "
    "or "
    "with real sensors (--rig, --camera DEVICE, ...).";

constexpr const char* kFirstExample =
    "  tether run face_anchor --target wait      # prints the environment that tasks need\n";

struct Example {
  std::string_view command;
  const char* text;
};
constexpr Example kExamples[] = {
    {"face_anchor", "--anchor blue_box"},
    {"face_anchor", "--anchor blue_box --precision-deg 1 --yaw-rate-deg-s 30"},
    {"relative_position", "--anchor blue_box --address 192.168.1.10:4810"},
    {"relative_position", "--anchor blue_box --rig bench.toml --camera /dev/video0"},
    {"move_forward", "--anchor blue_box --speed-m-s 0.3"},
    {"closed_path", "--anchor blue_box --distance-m 1 --clock 'cpu*20'"},
    {"sensor_characterization", "--sensor camera --acquisitions 100"},
    {"go_to", "--ahead-m 2 --up-m 0.5"},
    {"search", "--anchor blue_box"},
    {"hold", "--duration-s 5"},
    {"inspect", "--anchor blue_box --distance-m 1.5 --duration-s 10"},
    {"land", "--speed-m-s 0.3"},
    {"land_on", "--anchor platform --descent-m-s 0.4"},
    {"search_pair", "--anchor blue_box"},
    {"avoid_by_scan", "--distance-m 12 --speed-m-s 2"},
    {"fly_through_gates", "--speed-m-s 2.5"},
    {"mission", "look_around.toml"},
    {"characterize", "--camera /dev/video0 --range iio:vl53l0x --out bench.toml"},
    {"calibrate", "--out board.toml"},
    {"calibrate", "--against board.toml --write-target my_board.toml"},
    {"calibrate", "--against board.toml --counted --write-target my_board.toml"}};

constexpr const char* kEnvironment = R"(
Environment (`tether run` sets it for the SUTs that it starts):
  TETHER_ADDRESS  address of the coordinator, host:port
  TETHER_TOKEN    token of the run, as printed by the coordinator
  TETHER_UAV      UAV to control; can be empty if there is only one
  TETHER_CLOCK    wall, cpu, counted, or cpu*FACTOR for a virtual target FACTOR times slower
  TETHER_OUT      folder of the run; output files are relative to it

Exit codes: 0 goal reached, 1 goal missed, 2 wrong use or a bad file, 3 set-up or connection failed.)";

/// The end of the help of a command; of the program if it is empty.
std::string footer_of(std::string_view command) {
  std::string text = "Examples:\n";
  if (command.empty()) text += kFirstExample;
  for (const Example& example : kExamples)
    if (command.empty() || command == example.command)
      text += "  tether-sut " + std::string(example.command) + " " + example.text + "\n";
  return text + kEnvironment;
}

// Kinds of values ---------------------------------------------------------------------------------

// Each returns what is wrong with a value; empty: nothing.

std::string even_is_wrong(const std::string& text) {
  const bool is_odd = !text.empty() && (text.back() - '0') % 2 == 1;
  return is_odd ? "" : text + " is not odd";
}

constexpr const char* kDevices =
    "a path with a '/', a number N for /dev/videoN, a stream's URL, or iio:NAME";

std::string no_device(const std::string& text) {
  return devices::is_device(text) ? "" : "invalid device \"" + text + "\". Use " + kDevices;
}

std::string no_profile_name(const std::string& text) {
  return calibration::is_profile_name(text)
             ? ""
             : "invalid name \"" + text +
                   "\". Use 1 to 64 letters, digits, '_', '-' and '.', not starting with '.'";
}

std::string no_file_name(const std::string& text) {
  return text.empty() ? "the name is empty" : "";
}

// Tasks -------------------------------------------------------------------------------------------

/// Where the value of a task's field goes, and what it may be.
struct Row {
  Option& option;

  void operator()(const rig::TextField& field) const {
    option.destination = field.value;
    option.words += " NAME";
    option.allowed.is_required = field.is_required;
  }
  void operator()(const rig::NumberField& field) const {
    option.destination = field.set;
    option.allowed = {.least = field.least, .most = field.most, .usual = app::shown(field.usual)};
  }
  void operator()(const rig::IntegerField& field) const {
    option.destination = field.value;
    option.allowed = app::range(field.least, field.most);
    if (field.is_odd) option.allowed.check = even_is_wrong;
  }
  void operator()(const rig::BooleanField& field) const {
    option.destination = field.value;
    option.words += " true|false";
  }
  void operator()(const rig::ChoiceField& field) const {
    const std::vector<std::string> words(field.words.begin(), field.words.end());
    option.destination = [set = field.set, words](const std::string& word) {
      set(static_cast<std::size_t>(std::ranges::find(words, word) - words.begin()));
    };
    option.allowed.words = words;
  }
};

Options task_options(rig::TaskSpec& spec) {
  Options options;
  for (const rig::Field& field : fields_of(spec)) {
    Option option{"--" + std::string(field.name), std::string(field.description), {}, {}};
    std::ranges::replace(option.words, '_', '-');
    std::visit(Row{option}, field.value);
    options.push_back(std::move(option));
  }
  return options;
}

// Everything else ---------------------------------------------------------------------------------

Options characterize_options(calibration::CharacterizeOptions& options) {
  static const std::map<std::string, calibration::Timing> kTimings = {
      {"auto", calibration::Timing::kAuto},
      {"on_demand", calibration::Timing::kOnDemand},
      {"periodic", calibration::Timing::kPeriodic}};
  return {{"--sensors NAME,NAME",
           "Names of sensors, separated by commas [all sensors]",
           &options.sensors,
           {.has_commas = true}},
          {"--acquisitions", "Acquisitions per experiment", &options.acquisitions,
           range(1, calibration::kMostAcquisitions)},
          {"--experiments", "Experiments per sensor; ten in the paper", &options.experiments,
           range(1, calibration::kMostAcquisitions)},
          {"--timing",
           "Timing model in the profile: on_demand (delay from request to data), periodic (period "
           "and delay of the sensor), or auto (periodic if the sensor has a rate and the model "
           "fits, otherwise on_demand)",
           [&options](const std::string& word) { options.timing = kTimings.at(word); },
           {.words = {"auto", "on_demand", "periodic"}, .usual = "auto"}},
          {"--name NAME", "Name of the profile [the name of this machine]", &options.name,
           checked(no_profile_name)},
          {"--out FILE", "File for the profile (TOML)", &options.out, checked(no_file_name)},
          {"--time-limit-s",
           "Time limit per sensor",
           [&options](double value) { options.time_limit = duration_from_seconds(value); },
           {.least = 0.001, .most = 1e6, .usual = app::shown(to_seconds(options.time_limit))}}};
}

Options calibrate_options(calibration::CalibrateOptions& options) {
  return {
      {"--rounds", "Measured rounds, after three warm-up rounds", &options.rounds,
       range(calibration::kLeastRounds, 100'000)},
      {"--cpu N", "CPU core to measure on, from 0 [the last one that is allowed]",
       &options.cpu_index, range(0, 100'000)},
      {"--out FILE", "File for the measurements (TOML)", &options.out, checked(no_file_name)},
      {"--against FILE", "Measurements of another machine; reports how many times longer it takes",
       &options.against, checked(no_file_name)},
      {"--measured FILE", "Earlier measurements of this machine, to use instead of measuring",
       &options.measured, checked(no_file_name)},
      {"--write-target FILE",
       "With --against: file for a virtual target on this machine that represents the "
       "other one (TOML), for --target of tether",
       &options.target, checked(no_file_name)},
      {"--counted",
       "With --against: instead of measuring here, count the work under an emulator and fit its "
       "costs; the target is the same on every machine",
       &options.counted},
      {"--cpu-model MODEL", "With --counted: CPU model for the emulator [Nehalem or cortex-a72]",
       &options.cpu_model},
      {"--program FILE", "With --counted: tether-sut for the other machine [this program]",
       &options.program, checked(no_file_name)},
      {"--sysroot FOLDER",
       "With --counted: folder of the libraries for that program [those of this machine]",
       &options.sysroot},
      {"--name NAME", "Name of the target [the name of the other machine]", &options.name,
       checked(no_profile_name)}};
}

Options real_row_options(rig::RealRowOptions& options) {
  return {{"--true-roi-px X,Y,W,H",
           "With real devices: the true box of the anchor in the image, in whole pixels "
           "from the top left; adds the angle error to the result",
           [&options](const std::vector<double>& v) {
             if (v[2] < 1.0 || v[3] < 1.0)
               throw std::invalid_argument("W and H must be at least 1");
             options.true_roi = rig::PixelBox{v[0], v[1], v[2], v[3]};
           },
           {.least = -1e5, .most = 1e5, .has_commas = true, .count = 4}},
          {"--keep-image FILE",
           "With real devices: file for the image of the last estimate, for annotation (PNG)",
           &options.keep_image, checked(no_file_name)}};
}

bool is_given(const rig::RealRowOptions& options) {
  return options.true_roi || !options.keep_image.empty();
}

/// Of a device, unless a task has the option for a sensor, which then accepts both.
Options devices_beside(const Options& own, rig::DeviceArguments& arguments) {
  Options options = {
      {"--camera DEVICE", std::string("Real camera: ") + kDevices, &arguments.camera,
       checked(no_device)},
      {"--imu DEVICE", "Real IMU: a folder like that of iio:deviceN, or iio:NAME", &arguments.imu,
       checked(no_device)},
      {"--range DEVICE", "Real rangefinder: a folder like that of iio:deviceN, or iio:NAME",
       &arguments.range, checked(no_device)}};
  std::erase_if(options, [&own](const Option& option) {
    return std::ranges::count(own, key_of(option), app::key_of) > 0;
  });
  return options;
}

/// The results of parsing.
struct Words {
  CommandLine line;
  std::vector<rig::TaskSpec> tasks;  ///< of each kind of task, in order
  rig::DeviceArguments devices;
  calibration::CharacterizeOptions characterize;
  calibration::CalibrateOptions calibrate;
  std::string mission_file;
  std::vector<std::string> anchors;  ///< of the world; empty: not known
};

/// Of a command that reads sensors.
Options link_options(Words& words) {
  return {
      {"--check", "Only read these options and their files: exit code 2 if something is wrong",
       &words.line.only_checks},
      {"--anchors NAME",
       "With --check: the anchors of the world; a task that needs another one is wrong",
       &words.anchors},
      {"--address ADDRESS", "Address of the coordinator, host:port (overrides TETHER_ADDRESS)",
       &words.line.address},
      {"--uav NAME", "UAV to control (overrides TETHER_UAV)", &words.line.uav},
      {"--clock CLOCK",
       "Clock of the SUT: wall, cpu or cpu*FACTOR (overrides TETHER_CLOCK). A run rejects a clock "
       "other than that of its condition",
       &words.line.clock},
      {"--rig FILE", "Use real devices instead of a coordinator: file that describes them (TOML)",
       &words.devices.rig}};
}

/// With the options of a command that reads sensors.
void add_sensing_command(CLI::App& program, std::string_view name, std::string_view help,
                         const Options& own, Words& words) {
  app::add_command(
      program, std::string(name), std::string(help),
      app::concatenated({own, link_options(words), devices_beside(own, words.devices)}),
      footer_of(name));
}

Refusal refusal(const std::string& what) {
  return {2, "tether-sut: " + what + "\n"};
}

/// CLI11's text for --help and --version; one line for an error.
Refusal refusal(const CLI::App& program, const CLI::ParseError& error) {
  if (error.get_exit_code() == 0) {
    std::ostringstream out;
    program.exit(error, out, out);
    return {0, out.str()};
  }
  return refusal(app::complaint(program, error));
}

void define_tasks(CLI::App& program, Words& words) {
  for (const rig::TaskKind& kind : rig::task_kinds())
    words.tasks.emplace_back().options = kind.defaults;
  for (std::size_t i = 0; i < words.tasks.size(); ++i) {
    rig::TaskSpec& spec = words.tasks[i];
    Options options = task_options(spec);
    if (std::holds_alternative<tasks::RelativePositionOptions>(spec.options))
      options = app::concatenated({options, real_row_options(words.line.real_row)});
    const rig::TaskKind& kind = rig::task_kinds()[i];
    add_sensing_command(program, kind.name, kind.description, options, words);
  }
}

void define_subcommands(CLI::App& program, Words& words) {
  define_tasks(program, words);
  add_sensing_command(
      program, "mission", "Run the tasks of a file in sequence",
      {{"file,--file,--mission FILE", "Mission file (TOML)", &words.mission_file, required()}},
      words);
  add_sensing_command(program, "characterize",
                      "Measure the timing of each sensor and write a profile",
                      characterize_options(words.characterize), words);
  app::add_command(program, "calibrate",
                   "Measure how fast this machine is; with --against, relative to another machine",
                   calibrate_options(words.calibrate), footer_of("calibrate"));
}

/// Takes the selected command, and checks its options.
Status take_command(const CLI::App& app, Words& words) {
  if (app.got_subcommand("calibrate")) {
    words.line.calibrate = words.calibrate;
    return check(words.calibrate);
  }
  if (app.got_subcommand("characterize")) {
    words.line.characterize = words.characterize;
    return check_extent(words.characterize,
                        std::max<std::size_t>(words.characterize.sensors.size(), 1));
  }
  if (app.got_subcommand("mission")) {
    Result<rig::Mission> loaded = rig::load_mission(words.mission_file);
    if (!loaded) return loaded.failure();
    words.line.mission = std::move(loaded).value();
    return ok_status();
  }
  for (std::size_t i = 0; i < words.tasks.size(); ++i) {
    if (app.got_subcommand(std::string(rig::task_kinds()[i].name))) {
      words.line.mission.tasks = {words.tasks[i]};
      take_devices(words.line.mission.tasks.front(), words.devices);
    }
  }
  return ok_status();
}

/// Checks options that need either a coordinator or real devices.
Status check_link(const CommandLine& line) {
  if (line.rig && (line.address || line.uav || line.clock)) {
    return Failure{
        Failure::Kind::kInvalid,
        "--address, --uav and --clock need a coordinator; they cannot be used with real devices"};
  }
  if (!line.rig && is_given(line.real_row)) {
    return Failure{Failure::Kind::kInvalid,
                   "--true-roi-px and --keep-image need real devices (--rig, --camera DEVICE)"};
  }
  return ok_status();
}

Status check_anchors(const rig::Mission& mission, const std::vector<std::string>& anchors) {
  const std::vector<std::string_view> names(anchors.begin(), anchors.end());
  for (const rig::TaskSpec& task : mission.tasks)
    if (!names.empty() && !task.anchor.empty() && std::ranges::count(names, task.anchor) == 0)
      return Failure{Failure::Kind::kInvalid, "the scenario has no anchor \"" + task.anchor +
                                                  "\"; " + allowed_hint(task.anchor, names)};
  return ok_status();
}

/// The command line from what CLI11 has parsed.
std::variant<CommandLine, Refusal> understand(const CLI::App& app, Words& words) {
  if (const Status mission = take_command(app, words); !mission)
    return refusal(mission.failure().message);
  if (const Status anchors = check_anchors(words.line.mission, words.anchors); !anchors)
    return refusal(anchors.failure().message);
  Result<std::optional<devices::Rig>> rig = make_rig(words.devices, words.line.mission);
  if (!rig) return refusal(rig.failure().message);
  words.line.rig = std::move(rig).value();
  if (const Status link = check_link(words.line); !link) return refusal(link.failure().message);
  return std::move(words.line);
}

}  // namespace

std::variant<CommandLine, Refusal> parse_command_line(int argc, const char* const* argv) {
  Words words;
  CLI::App program(kDescription, "tether-sut");
  program.set_version_flag("--version", "tether-sut " + std::string(version()));
  program.footer(footer_of(""));
  program.require_subcommand(1);
  program.formatter(app::help_format(os::text_columns(STDOUT_FILENO)));  // of the commands too
  define_subcommands(program, words);
  std::string shell;
  app::add_completion_command(program, shell);
  if (const auto page = app::asked_manual_page(program, {argv + 1, argv + argc}))
    return Refusal{0, *page};
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return refusal(program, error);
  }
  if (!shell.empty()) return Refusal{0, app::completion_script(program, shell)};
  return understand(program, words);
}

}  // namespace tether::sut
