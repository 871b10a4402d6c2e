#include "commands/program_scenario.h"

#include "options/refuse_option.h"

#include <algorithm>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <tether/autopilot/external.h>
#include <tether/os/child_process.h>
#include <tether/os/text_file.h>
#include <tether/runner/trial_folder.h>
#include <tether/scenario/scenario.h>
#include <tether/toml/table.h>

namespace tether::app {

namespace {

namespace fs = std::filesystem;
using scenario::ShippedKind;

constexpr const char* kWorld = "yard";
constexpr const char* kModel = "hummingbird";
constexpr const char* kProfile = "paper_streaming";
/// Above the ground, where a flight controller sets it down. Of another UAV, little is known.
constexpr double kHeight_m = 0.1, kHeightOfOthers_m = 0.5;
/// Of shipped worlds with something in the middle.
struct FreePlace {
  std::string_view world;
  double x_m = 0.0, y_m = 0.0;
};
constexpr FreePlace kFreePlaces[] = {{"room", 1.2, 0.0}, {"bays", 1.2, -1.7}};
constexpr double kTimeLimit_s = 120.0;
constexpr double kCpuFactor = 6.0;

Allowed usually(Allowed allowed, std::string usual) {
  allowed.usual = std::move(usual);
  return allowed;
}

/// A string of TOML, whose escapes are those of JSON.
std::string toml_text(const std::string& text) try {
  return nlohmann::json(text).dump();
} catch (const nlohmann::json::exception&) {
  refuse_option("--", fmt::format("'{}' is not UTF-8, as the text of a scenario has to be", text));
}

std::string toml_list(const std::vector<std::string>& texts) {
  std::vector<std::string> quoted(texts.size());
  std::ranges::transform(texts, quoted.begin(), toml_text);
  return fmt::format("[{}]", fmt::join(quoted, ", "));
}

/// A path of the command line is not that of a file elsewhere.
std::string file_text(const scenario::ShippedFiles& shipped, ShippedKind kind,
                      const std::string& option, const std::string& given) try {
  return toml_text(shipped.named(kind, given, {}) ? given : fs::absolute(given).string());
} catch (const Error& error) {
  refuse_option(option, error.what());
}

bool is_file(const std::string& word) {
  std::error_code ignored;
  return fs::is_regular_file(word, ignored);
}

/// Programs that run a script; without their versions.
bool is_interpreter(const std::string& program) {
  constexpr std::string_view kInterpreters[] = {"python", "node", "sh",   "bash", "dash",
                                                "ruby",   "perl", "java", "lua",  "env"};
  const std::string name = fs::path(program).filename();
  const std::string_view kind =
      std::string_view(name).substr(0, name.find_last_not_of("0123456789.") + 1);
  return std::ranges::count(kInterpreters, kind) > 0;
}

/// The index of the script that an interpreter runs; 0: the program itself.
std::size_t script_of(const std::vector<std::string>& command) {
  if (!is_interpreter(command.front())) return 0;
  const auto script = std::find_if(command.begin() + 1, command.end(), is_file);
  return script == command.end() ? 0 : static_cast<std::size_t>(script - command.begin());
}

std::string script_name(const std::vector<std::string>& command) {
  constexpr std::size_t kMost = 64;
  std::string name = fs::path(command[script_of(command)]).stem();
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '.') c = '_';
  if (name.empty() || name.front() == '.') name.insert(0, "program");
  return name.substr(0, kMost);
}

std::vector<std::string> controllers() {
  std::vector<std::string> keys = {"built-in", "none"};
  for (const autopilot::External& external : autopilot::externals())
    keys.emplace_back(external.key);
  return keys;
}

/// What a place of the template gets, in TOML, and the option that decides it: "--world yard", or
/// empty for the program itself.
struct Value {
  std::string text;
  std::string option{};
};
using Values = std::map<std::string, Value, std::less<>>;

Value file_value(const scenario::ShippedFiles& shipped, ShippedKind kind, const std::string& option,
                 const std::string& given) {
  return {file_text(shipped, kind, option, given), option + " " + given};
}

Value number_value(const std::string& option, double number) {
  return {toml::number_text(number), option + " " + toml::number_text(number)};
}

Values values_of(const ProgramOptions& options, const std::string& profile,
                 const scenario::ShippedFiles& shipped) {
  std::vector<std::string> command = options.command;
  if (command.front().find('/') != std::string::npos)
    command.front() = fs::absolute(command.front()).lexically_normal();
  // So that the scenario can be flown from any folder.
  if (const std::size_t script = script_of(command); script > 0)
    command[script] = fs::absolute(command[script]).lexically_normal();
  const std::string controller =
      options.flight_controller.value_or(options.uses_library ? "none" : "built-in");
  const auto external =
      std::ranges::find(autopilot::externals(), controller, &autopilot::External::key);
  if (external != autopilot::externals().end() && !options.controller_path)
    refuse_option(
        "--flight-controller",
        fmt::format("{} needs your build of it. Add --controller-path FOLDER", controller));
  if (options.starts_in_air && controller == "none")
    refuse_option("--starts-in-air", "needs a flight controller that holds the UAV in the air");
  const double limit_s = options.time_limit_s.value_or(kTimeLimit_s);
  const std::string model = options.model.value_or(kModel);
  const Value model_value = file_value(shipped, ShippedKind::kModel, "--model", model);
  const bool is_shipped = shipped.named(ShippedKind::kModel, model, {}).has_value();
  const std::string world = options.world.value_or(kWorld);
  const auto* const free = std::ranges::find(kFreePlaces, world, &FreePlace::world);
  std::vector<double> start = {0.0, 0.0, is_shipped ? kHeight_m : kHeightOfOthers_m};
  if (free != std::end(kFreePlaces)) start = {free->x_m, free->y_m, start[2]};
  const std::string place =
      fmt::format("[{}]", fmt::join(options.position_m.value_or(start), ", "));
  if (options.has_one_process && options.uses_library)
    refuse_option("--one-process", "is for a program without Tether's library");
  Values values = {
      {"name", {toml_text(script_name(options.command))}},
      {"world", file_value(shipped, ShippedKind::kWorld, "--world", world)},
      {"model", model_value},
      {"time_limit", number_value("--time-limit", limit_s)},
      {"end", {toml::number_text(limit_s + 1.0), number_value("--time-limit", limit_s).option}},
      {"position", {place, "--position " + place}},
      {"flight_controller", {toml_text(controller), "--flight-controller " + controller}},
      {"command", {toml_list(command)}},
      {"as_is", {options.uses_library ? "false" : "true"}},
      {"all_processes",
       {options.uses_library || options.has_one_process ? "false" : "true",
        options.has_one_process ? "--one-process" : ""}},
      {"cpu_factor", number_value("--cpu-factor", options.cpu_factor.value_or(kCpuFactor))}};
  if (!options.anchors.empty())
    values["anchors"] = {toml_list(options.anchors), "--anchor " + options.anchors.front()};
  if (options.controller_path)
    values["controller_path"] = {toml_text(fs::absolute(*options.controller_path)),
                                 "--controller-path " + *options.controller_path};
  // The sensors of another UAV are as its file says.
  if (!profile.empty() || is_shipped)
    values["profile"] = file_value(shipped, ShippedKind::kProfile, "--profile",
                                   profile.empty() ? kProfile : profile);
  if (options.starts_in_air) values["starts_in_air"] = {"true", "--starts-in-air"};
  return values;
}

/// The place of a line such as "world = {world}"; empty: it has none.
std::string place_in(const std::string& line) {
  const std::size_t begin = line.find(" = {");
  return begin == std::string::npos ? "" : line.substr(begin + 4, line.find('}') - begin - 4);
}

}  // namespace

Options program_rows(ProgramOptions& o) {
  return {
      {"program",
       "After --, in place of a scenario: a program that knows nothing of Tether, and its "
       "arguments. It flies unchanged, and its exit code says whether it reached its goal. The "
       "scenario is made of the following options, and written as scenario.toml into --out",
       &o.command,
       {.follows_dashes = true}},
      {"--world WORLD", "For a program: name of a shipped world, or a file (SDF)", &o.world,
       usually({}, kWorld)},
      {"--model MODEL", "For a program: name of a shipped UAV, or a file (SDF)", &o.model,
       usually({}, kModel)},
      {"--position X,Y,Z",
       "For a program: where the UAV starts, in metres; 0.5 m high for a --model of your own, and "
       "beside what stands in the middle of a shipped world",
       &o.position_m,
       {.has_commas = true, .count = 3, .usual = "0,0,0.1"}},
      {"--flight-controller", "For a program: what flies the UAV at its commands",
       &o.flight_controller, usually(one_of(controllers()), "built-in")},
      {"--controller-path FOLDER",
       "For a program: your build of the flight controller, if that is PX4 or ArduPilot",
       &o.controller_path},
      {"--starts-in-air",
       "For a program: it finds the UAV in flight, armed. Only with the built-in flight controller",
       &o.starts_in_air},
      {"--time-limit", "For a program: simulated time in seconds within which it has to end",
       &o.time_limit_s,
       usually(range(0.1, scenario::kLongestRun_s - 1.0), toml::number_text(kTimeLimit_s))},
      {"--anchor NAME",
       "For a program: a model of the world whose true place the record has; can be repeated",
       &o.anchors,
       {.is_one_each = true}},
      {"--cpu-factor",
       "For a program: fly the condition \"target\" of the scenario, this machine so many times "
       "slower [fly \"host\", this machine as it is]",
       &o.cpu_factor, range(1e-3, 1e4)},
      {"--uses-library",
       "For a program: it uses Tether's library. Without --flight-controller, it commands the UAV "
       "itself",
       &o.uses_library},
      {"--one-process",
       "For a program: only the process that the command starts flies, and one of its threads may "
       "compute at a time. Without, all threads and processes, such as the nodes of ROS, share one "
       "core of this machine",
       &o.has_one_process}};
}

void require_no_program_options(ProgramOptions o) {
  const auto is_given = [](const auto& to) {
    if constexpr (std::is_same_v<decltype(to), bool* const&>)
      return *to;
    else if constexpr (requires { to->has_value(); })
      return to->has_value();
    else if constexpr (requires { to->empty(); })
      return !to->empty();
    else
      return false;
  };
  for (const Option& row : program_rows(o))
    if (!row.allowed.follows_dashes && std::visit(is_given, row.destination))
      refuse_option(key_of(row),
                    "is for a program that follows '--'. Change values of a scenario's file with "
                    "--set KEY=VALUE");
}

ProgramScenario make_program_scenario(const ProgramOptions& options, const std::string& profile,
                                      const scenario::ShippedFiles& shipped) {
  const Values values = values_of(options, profile, shipped);
  ProgramScenario made{.name = script_name(options.command),
                       .text = std::string(runner::kMadeScenario) +
                               ". Without this line, the file is yours and is not replaced.\n",
                       .options = {}};
  std::istringstream lines(os::read_file(shipped.folder() / "templates/program.toml"));
  int number = 1;
  for (std::string line; std::getline(lines, line);) {
    const std::string place = place_in(line);
    const auto value = values.find(place);
    if (!place.empty() && value == values.end()) continue;  // left out: nobody decides it
    ++number;
    if (!place.empty()) {
      line.replace(line.find('{'), place.size() + 2, value->second.text);
      made.options[number] = value->second.option;
    }
    made.text += line + "\n";
  }
  return made;
}

Error about_option(const Error& error, const fs::path& file, const ProgramScenario& made) {
  if (error.where().file != file.string()) return error;
  const std::string what = std::string(error.what()).substr(located(error.where(), "").size());
  const auto told = [&](const std::string& message) {
    return Error(ErrorCode::kUsage, message).about(error.subject());
  };
  if (error.where().line == 0) return told(fmt::format("the scenario of {} {}", made.name, what));
  const auto option = made.options.find(error.where().line);
  if (option == made.options.end()) return error;
  return told(option->second.empty() ? what : option->second + ": " + what);
}

ProgramScenarioFile::ProgramScenarioFile(const fs::path& folder, const ProgramScenario& made)
    : path_(fs::absolute(folder / runner::kMadeScenarioFile)) {
  const std::string begin = os::begin_of(path_, runner::kMadeScenario.size());
  if (fs::exists(path_) && begin != runner::kMadeScenario)
    throw Error(ErrorCode::kUsage, {path_.string()},
                fmt::format("is not replaced, because it is not as this command makes it. To fly "
                            "it, type: tether run {}. Or choose another folder with --out",
                            os::shell_word(path_.string())))
        .about(path_.string());
  for (fs::path one = path_; !fs::exists(one); one = one.parent_path()) new_.push_back(one);
  std::error_code failed;
  fs::create_directories(path_.parent_path(), failed);
  if (failed)
    throw Error(ErrorCode::kSetup, {path_.parent_path().string()}, failed.message())
        .about(path_.parent_path().string());
  os::write_file_atomically(path_, made.text);
}

ProgramScenarioFile::~ProgramScenarioFile() {
  std::error_code ignored;  // what has other files stays
  for (const fs::path& one : new_) fs::remove(one, ignored);
}

}  // namespace tether::app
