#include "sut_environment.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <tether/os/child_process.h>
#include <tether/os/shell_word.h>

namespace tether::runner {

coordinator::ClockSetting clock_of(const scenario::Condition& condition) {
  using link::ClockKind;
  // In the order of scenario::Clock.
  constexpr ClockKind kKinds[] = {ClockKind::kWall,      ClockKind::kCpu,     ClockKind::kScripted,
                                  ClockKind::kUnstamped, ClockKind::kCounted, ClockKind::kReplayed};
  return {kKinds[static_cast<std::size_t>(condition.clock)], condition.cpu_factor,
          condition.computing};
}

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

SutCommand sut_command(const scenario::Sut& sut, const std::optional<scenario::Target>& target) {
  SutCommand command{{}, 0};
  if (sut.concurrent) command.words.emplace_back("tether-exec");
  std::vector<std::string> words = command_line(sut);
  if (target) {
    std::string& program = words.front();
    if (!target->program_folder.empty() && program.find('/') == std::string::npos)
      program = (std::filesystem::path(target->program_folder) / program).string();
    command.words.insert(command.words.end(), target->launcher.begin(), target->launcher.end());
  }
  command.program = command.words.size();
  command.words.insert(command.words.end(), words.begin(), words.end());
  return command;
}

os::Environment environment_of(const std::string& uav, std::size_t index, const SutRun& run) {
  const auto own = run.addresses.find(index);
  os::Environment environment = {
      {"TETHER_ADDRESS", own == run.addresses.end() ? run.address : own->second},
      {"TETHER_TOKEN", run.token},
      {"TETHER_UAV", uav},
      {"TETHER_CLOCK", to_text(clock_of(for_uav(run.condition, index)))}};
  if (const auto counts = run.counts.find(index); counts != run.counts.end()) {
    const os::Environment counting = counts->second.environment();
    environment.insert(environment.end(), counting.begin(), counting.end());
  }
  return environment;
}

std::string sut_instructions(const scenario::Scenario& scenario, const SutRun& run, bool all) {
  std::string text;
  for (std::size_t i = 0; i < scenario.uavs.size(); ++i) {
    if (!all && !for_uav(run.condition, i).by_hand) continue;
    const scenario::UavSetup& uav = scenario.uavs[i];
    for (const auto& [name, value] : environment_of(uav.placement.name, i, run))
      text += fmt::format("{}={} ", name, os::shell_word(value));
    std::vector<std::string> words = sut_command(uav.sut, for_uav(run.condition, i).target).words;
    std::transform(words.begin(), words.end(), words.begin(), os::shell_word);
    text += fmt::format("{}\n", fmt::join(words, " "));
  }
  return text;
}

}  // namespace tether::runner
