#include "command_line.h"

#include "shared/complaint.h"
#include "shared/completion.h"
#include "shared/help.h"
#include "shared/within.h"

#include <algorithm>
#include <map>
#include <sstream>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <unistd.h>

#include <tether/base/suggest.h>
#include <tether/base/units.h>
#include <tether/base/version.h>
#include <tether/calibration/profile_text.h>
#include <tether/os/terminal.h>
#include <tether/rig/device_arguments.h>
#include <tether/rig/mission_file.h>
#include <tether/rig/task_fields.h>

// The options of all commands; of this program, only this source includes CLI11. The options of
// tasks are made from rig::task_fields, the others are defined here. After CLI11 has parsed the
// arguments, understand() checks which options can be combined. docs/man/tether-sut.1 describes
// the same options.

namespace tether::sut {
namespace {

using app::shown;
using app::within;

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
    {"search_pair", "--anchor blue_box"},
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

CLI::Validator odd() {
  return CLI::Validator(
      [](std::string& text) {
        const bool is_odd = !text.empty() && (text.back() - '0') % 2 == 1;
        return is_odd ? std::string() : text + " is not odd";
      },
      "odd");
}

constexpr const char* kDevices =
    "a path with a '/', a number N for /dev/videoN, a stream's URL, or iio:NAME";

CLI::Validator device() {
  return CLI::Validator(
      [](std::string& text) {
        return devices::is_device(text) ? std::string()
                                        : "invalid device \"" + text + "\". Use " + kDevices;
      },
      "DEVICE");
}

CLI::Validator profile_name() {
  return CLI::Validator(
      [](std::string& text) {
        return calibration::is_profile_name(text)
                   ? std::string()
                   : "invalid name \"" + text +
                         "\". Use 1 to 64 letters, digits, '_', '-' and '.', not "
                         "starting with '.'";
      },
      "NAME");
}

CLI::Validator file_name() {
  return CLI::Validator(
      [](std::string& text) {
        return text.empty() ? std::string("the name is empty") : std::string();
      },
      "FILE");
}

/// "12,40,80,60" in whole pixels.
void add_pixel_box(CLI::App& app, const std::string& name, std::optional<rig::PixelBox>& box,
                   const std::string& description) {
  app.add_option_function<std::vector<double>>(
         name,
         [&box](const std::vector<double>& v) {
           box = rig::PixelBox{v[0], v[1], v[2], v[3]};
           if (box->width_px < 1.0 || box->height_px < 1.0)
             throw CLI::ValidationError("--true-roi-px", "W and H must be at least 1");
         },
         description)
      ->delimiter(',')
      ->expected(4)
      ->check(within(-1e5, 1e5))
      ->type_name("X,Y,W,H");
}

// Tasks -------------------------------------------------------------------------------------------

/// Defines the option of a task's field.
class OptionOf {
 public:
  OptionOf(CLI::App& app, const rig::Field& field)
      : app_(app), name_("--" + std::string(field.name)), description_(field.description) {
    std::replace(name_.begin(), name_.end(), '_', '-');
  }

  void operator()(const rig::TextField& field) const {
    CLI::Option* option = app_.add_option(name_, *field.value, description_);
    if (field.is_required)
      option->required();
    else
      option->capture_default_str();
  }
  void operator()(const rig::NumberField& field) const {
    app_.add_option_function<double>(name_, field.set, description_)
        ->check(within(field.least, field.most))
        ->default_str(shown(field.usual));
  }
  void operator()(const rig::IntegerField& field) const {
    CLI::Option* option = app_.add_option(name_, *field.value, description_)
                              ->check(within(field.least, field.most))
                              ->capture_default_str();
    if (field.is_odd) option->check(odd());
  }
  void operator()(const rig::BooleanField& field) const {
    app_.add_option(name_, *field.value, description_)->capture_default_str();
  }
  void operator()(const rig::ChoiceField& field) const {
    const std::vector<std::string> words(field.words.begin(), field.words.end());
    app_.add_option_function<std::string>(
            name_,
            [set = field.set, words](const std::string& word) {
              set(static_cast<std::size_t>(std::find(words.begin(), words.end(), word) -
                                           words.begin()));
            },
            description_)
        ->check(CLI::IsMember(words))
        ->type_name("NAME");
  }

 private:
  CLI::App& app_;
  std::string name_;
  std::string description_;
};

void add_task_options(CLI::App& app, rig::TaskSpec& spec) {
  for (const rig::Field& field : fields_of(spec)) std::visit(OptionOf(app, field), field.value);
}

// Everything else ---------------------------------------------------------------------------------

void add_characterize_options(CLI::App& app, calibration::CharacterizeOptions& options) {
  static const std::map<std::string, calibration::Timing> kTimings = {
      {"auto", calibration::Timing::kAuto},
      {"on_demand", calibration::Timing::kOnDemand},
      {"periodic", calibration::Timing::kPeriodic}};
  app.add_option("--sensors", options.sensors,
                 "Names of sensors, separated by commas [all sensors]")
      ->delimiter(',')
      ->type_name("NAME,NAME");
  app.add_option("--acquisitions", options.acquisitions, "Acquisitions per experiment")
      ->check(within(1, calibration::kMostAcquisitions))
      ->capture_default_str();
  app.add_option("--experiments", options.experiments, "Experiments per sensor; ten in the paper")
      ->check(within(1, calibration::kMostAcquisitions))
      ->capture_default_str();
  app.add_option(
         "--timing", options.timing,
         "Timing model in the profile: on_demand (delay from request to data), periodic (period "
         "and "
         "delay of the sensor), or auto (periodic if the sensor has a rate and the model fits, "
         "otherwise on_demand) [auto]")
      ->transform(CLI::Transformer(kTimings))
      ->type_name("NAME");
  app.add_option("--name", options.name, "Name of the profile [name of this machine]")
      ->check(profile_name())
      ->type_name("NAME");
  app.add_option("--out", options.out, "File for the profile (TOML)")
      ->check(file_name())
      ->type_name("FILE");
  app.add_option_function<double>(
         "--time-limit-s",
         [&options](double value) { options.time_limit = duration_from_seconds(value); },
         "Time limit per sensor")
      ->check(within(0.001, 1e6))
      ->default_str(shown(to_seconds(options.time_limit)));
}

void add_calibrate_options(CLI::App& app, calibration::CalibrateOptions& options) {
  const auto add_file = [&app](const char* name, std::string& file, const char* description) {
    app.add_option(name, file, description)->check(file_name())->type_name("FILE");
  };
  app.add_option("--rounds", options.rounds, "Measured rounds, after three warm-up rounds")
      ->check(within(calibration::kLeastRounds, 100'000))
      ->capture_default_str();
  app.add_option("--cpu", options.cpu_index,
                 "CPU core to measure on, from 0 [the last one that is allowed]")
      ->check(within(0, 100'000))
      ->type_name("N");
  add_file("--out", options.out, "File for the measurements (TOML)");
  add_file("--against", options.against,
           "Measurements of another machine; reports how many times longer it takes");
  add_file("--measured", options.measured,
           "Earlier measurements of this machine, to use instead of measuring");
  add_file(
      "--write-target", options.target,
      "With --against: file for a virtual target on this machine that represents the other one "
      "(TOML)");
  app.add_flag(
      "--counted", options.counted,
      "With --against: instead of measuring here, count the work under an emulator and fit "
      "its costs; the target is the same on every machine");
  app.add_option("--cpu-model", options.cpu_model,
                 "With --counted: CPU model for the emulator [Nehalem or cortex-a72]")
      ->type_name("MODEL");
  add_file("--program", options.program,
           "With --counted: tether-sut for the other machine [this program]");
  app.add_option("--sysroot", options.sysroot,
                 "With --counted: folder of the libraries for that program [those of this machine]")
      ->type_name("FOLDER");
  app.add_option("--name", options.name, "Name of the target [name of the other machine]")
      ->check(profile_name())
      ->type_name("NAME");
}

void add_real_row_options(CLI::App& app, rig::RealRowOptions& options) {
  add_pixel_box(
      app, "--true-roi-px", options.true_roi,
      "With real devices: the true box of the anchor in the image, in whole pixels from the "
      "top left; adds the angle error to the result");
  app.add_option("--keep-image", options.keep_image,
                 "With real devices: file for the image of the last estimate, for annotation (PNG)")
      ->check(file_name())
      ->type_name("FILE");
}

bool is_given(const rig::RealRowOptions& options) {
  return options.true_roi || !options.keep_image.empty();
}

void add_unless_there(CLI::App& app, const std::string& name, std::string& value,
                      const std::string& description) {
  if (app.get_option_no_throw(name) == nullptr)
    app.add_option(name, value, description)->check(device())->type_name("");
}

/// Adds --rig, and --camera, --imu and --range unless the task has them. Those of a task accept
/// both the name of a sensor and a device.
void add_device_options(CLI::App& app, rig::DeviceArguments& arguments) {
  app.add_option("--rig", arguments.rig,
                 "Use real devices instead of a coordinator: file that describes them (TOML)")
      ->type_name("FILE");
  add_unless_there(app, "--camera", arguments.camera, std::string("Real camera: ") + kDevices);
  add_unless_there(app, "--imu", arguments.imu,
                   "Real IMU: a folder like that of iio:deviceN, or iio:NAME");
  add_unless_there(app, "--range", arguments.range,
                   "Real rangefinder: a folder like that of iio:deviceN, or iio:NAME");
}

void add_link_options(CLI::App& app, CommandLine& line) {
  app.add_option("--address", line.address,
                 "Address of the coordinator, host:port (overrides TETHER_ADDRESS)");
  app.add_option("--uav", line.uav, "UAV to control (overrides TETHER_UAV)");
  app.add_option("--clock", line.clock,
                 "Clock of the SUT: wall, cpu or cpu*FACTOR (overrides TETHER_CLOCK)");
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

/// `define` adds the subcommand's own options.
template <class Define>
CLI::App* add_subcommand(CLI::App& app, std::string_view name, std::string_view description,
                         Words& words, Define define) {
  CLI::App* command = app.add_subcommand(std::string(name), std::string(description));
  define(*command);
  command->add_flag("--check", words.line.only_checks,
                    "Only read these options and their files: exit code 2 if something is wrong");
  command
      ->add_option("--anchors", words.anchors,
                   "With --check: the anchors of the world; a task that needs another one is wrong")
      ->type_name("NAME");
  add_link_options(*command, words.line);
  add_device_options(*command, words.devices);
  command->footer(footer_of(name));
  return command;
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

void define_tasks(CLI::App& app, Words& words) {
  for (const rig::TaskKind& kind : rig::task_kinds())
    words.tasks.emplace_back().options = kind.defaults;
  for (std::size_t i = 0; i < words.tasks.size(); ++i) {
    rig::TaskSpec& spec = words.tasks[i];
    const rig::TaskKind& kind = rig::task_kinds()[i];
    add_subcommand(app, kind.name, kind.description, words, [&](CLI::App& command) {
      add_task_options(command, spec);
      if (std::holds_alternative<tasks::RelativePositionOptions>(spec.options))
        add_real_row_options(command, words.line.real_row);
    });
  }
}

void define_subcommands(CLI::App& app, Words& words) {
  define_tasks(app, words);
  add_subcommand(
      app, "mission", "Run the tasks of a file in sequence", words, [&](CLI::App& command) {
        command.add_option("file,--file,--mission", words.mission_file, "Mission file (TOML)")
            ->required();
      });
  add_subcommand(app, "characterize", "Measure the timing of each sensor and write a profile",
                 words,
                 [&](CLI::App& command) { add_characterize_options(command, words.characterize); });
  CLI::App* calibrate = app.add_subcommand(
      "calibrate", "Measure how fast this machine is; with --against, relative to another machine");
  add_calibrate_options(*calibrate, words.calibrate);
  calibrate->footer(footer_of("calibrate"));
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
    return Failure{Failure::Kind::kInvalid,
                   "--address, --uav and --clock need a coordinator; they cannot be used with real "
                   "devices"};
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
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return refusal(program, error);
  }
  if (!shell.empty()) return Refusal{0, app::completion_script(program, shell)};
  return understand(program, words);
}

}  // namespace tether::sut
