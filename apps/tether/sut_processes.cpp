#include "sut_processes.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <tether/base/error.h>

namespace tether::app {

namespace {

// How long a SUT that has finished may take to leave.
constexpr Duration kLeaveLimit = std::chrono::seconds(2);
// How long a lost SUT's process may take to end once its connection has.
constexpr Duration kEndLimit = std::chrono::milliseconds(200);

/// The SUT's program with its parameters as options: max_frames = 5 becomes --max-frames 5.
std::vector<std::string> command_line(const scenario::Sut& sut) {
  std::vector<std::string> words = sut.command;
  for (const auto& [key, value] : sut.parameters) {
    std::string option = "--" + key;
    std::replace(option.begin(), option.end(), '_', '-');
    words.push_back(option);
    words.push_back(value);
  }
  return words;
}

/// As the client library takes it.
std::string clock_of(const scenario::Condition& condition) {
  switch (condition.clock) {
    case scenario::Clock::kWall:
      return "wall";
    case scenario::Clock::kCpu:
      return fmt::format("cpu*{}", condition.cpu_factor);
    case scenario::Clock::kScripted:
      return fmt::format("scripted*{}", static_cast<double>(condition.computing.count()) / 1e6);
  }
  return "wall";
}

std::vector<std::pair<std::string, std::string>> environment_of(const std::string& uav,
                                                                const SutRun& run) {
  return {{"TETHER_ADDRESS", run.address},
          {"TETHER_TOKEN", run.token},
          {"TETHER_UAV", uav},
          {"TETHER_CLOCK", clock_of(run.condition)}};
}

/// Where a SUT may leave files of its own: the whole path.
std::string files_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw Error(ErrorCode::kSetup, folder.string() + ": " + error.message());
  return std::filesystem::absolute(folder).lexically_normal().string();
}

/// As a shell takes it for one word and nothing more.
std::string shell_word(const std::string& text) {
  const bool is_plain = std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) ||
           std::string_view("_.:/-").find(static_cast<char>(c)) != std::string_view::npos;
  });
  return is_plain && !text.empty() ? text : "'" + text + "'";
}

}  // namespace

std::string sut_instructions(const scenario::Scenario& scenario, const SutRun& run) {
  std::string text;
  for (const scenario::UavSetup& uav : scenario.uavs) {
    for (const auto& [name, value] : environment_of(uav.placement.name, run))
      text += fmt::format("{}={} ", name, shell_word(value));
    std::vector<std::string> words = command_line(uav.sut);
    std::transform(words.begin(), words.end(), words.begin(), shell_word);
    text += fmt::format("{}\n", fmt::join(words, " "));
  }
  return text;
}

void require_sut_programs(const scenario::Scenario& scenario) {
  for (const scenario::UavSetup& uav : scenario.uavs) try {
      find_program(uav.sut.command.front());
    } catch (const Error& e) {
      throw Error(ErrorCode::kBadFile, {scenario.file.string()},
                  fmt::format("the SUT of UAV \"{}\": {}", uav.placement.name, e.what()));
    }
}

void SutProcesses::start(const scenario::Scenario& scenario, const SutRun& run,
                         const std::filesystem::path& folder) {
  for (const scenario::UavSetup& uav : scenario.uavs) {
    const std::string& name = uav.placement.name;
    const std::filesystem::path log = folder / fmt::format("sut-{}.log", name);
    auto environment = environment_of(name, run);
    environment.emplace_back("TETHER_OUT",
                             files_folder(scenario.uavs.size() > 1 ? folder / name : folder));
    suts_.push_back(
        {name, log,
         std::make_unique<ChildProcess>(ChildCommand{.arguments = command_line(uav.sut),
                                                     .environment = std::move(environment),
                                                     .log = log})});
  }
}

std::optional<std::string> SutProcesses::early_end() {
  for (Sut& sut : suts_)
    if (sut.process->poll()) return describe_end(sut);
  return std::nullopt;
}

std::string SutProcesses::post_mortem() {
  std::string text;
  for (Sut& sut : suts_)
    if (sut.process->wait(kEndLimit)) text += "; " + describe_end(sut);
  return text;
}

void SutProcesses::let_leave() {
  for (Sut& sut : suts_) sut.process->wait(kLeaveLimit);
}

std::string SutProcesses::describe_end(Sut& sut) {
  std::ifstream log(sut.log);
  std::string last;
  for (std::string line; std::getline(log, line);)
    if (!line.empty()) last = line;
  return fmt::format(
      "the SUT of UAV \"{}\" ({}) {}{}", sut.uav, sut.process->program(),
      sut.process->poll()->description,
      last.empty() ? "" : fmt::format("; its last words in {}: {}", sut.log.string(), last));
}

}  // namespace tether::app
