#include "suts/sut_environment.h"

#include "suts/local_sut.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <tether/os/child_process.h>

namespace tether::runner {

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

const SutGroup* group_of(const SutRun& run, std::size_t uav) {
  const auto found = std::ranges::find_if(
      run.groups, [uav](const SutGroup& group) { return std::ranges::count(group.uavs, uav) > 0; });
  return found == run.groups.end() ? nullptr : &*found;
}

std::vector<std::string> group_command(const SutGroup& group) {
  return {"tether-exec", "--group", group.socket, "--members", std::to_string(group.uavs.size())};
}

SutCommand sut_command(const scenario::Sut& sut, const std::optional<scenario::Target>& target,
                       const std::string& group) {
  SutCommand command;
  if (!group.empty())
    command.words = {"tether-exec", "--group", group};
  else if (sut.concurrent)
    command.words = {"tether-exec"};
  command.supervisor = command.words.size();
  std::vector<std::string> words = command_line(sut);
  if (target) {
    std::string& program = words.front();
    if (!target->program_folder.empty() && program.find('/') == std::string::npos)
      program = (std::filesystem::path(target->program_folder) / program).string();
    command.words.insert(command.words.end(), target->launcher.begin(), target->launcher.end());
  }
  if (sut.is_as_is) command.words.insert(command.words.end(), {"tether-exec", "--as-is"});
  if (sut.has_all_processes) command.words.emplace_back("--all-processes");
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
      {"TETHER_CLOCK", computer_of(run.condition, index).clock.text()}};
  if (const auto counts = run.counts.find(index); counts != run.counts.end()) {
    const os::Environment counting = counts->second.environment();
    environment.insert(environment.end(), counting.begin(), counting.end());
  }
  return environment;
}

namespace {

// A counted program runs on this machine, with whose memory it shares its counts. The emulator, and
// the shell in which the user starts it, find programs by other rules than Tether.
std::vector<std::string> words_by_hand(const scenario::Sut& sut,
                                       const std::optional<scenario::Target>& target,
                                       const std::string& group) {
  const bool is_counted = target && target->emulator;
  return is_counted ? local_sut_command(sut, target, group).words
                    : sut_command(sut, target, group).words;
}

}  // namespace

std::string sut_instructions(const scenario::Scenario& scenario, const SutRun& run, bool all) {
  std::string text;
  const auto add = [&](std::size_t uav, std::vector<std::string> words) {
    for (const auto& [name, value] : environment_of(scenario.uavs[uav].placement.name, uav, run))
      text += fmt::format("{}={} ", name, os::shell_word(value));
    std::transform(words.begin(), words.end(), words.begin(), os::shell_word);
    text += fmt::format("{}\n", fmt::join(words, " "));
  };
  for (std::size_t i = 0; i < scenario.uavs.size(); ++i) {
    const scenario::Computer& own = computer_of(run.condition, i);
    if (!all && !own.by_hand) continue;
    const SutGroup* const group = group_of(run, i);
    if (group && group->uavs.front() == i) add(i, group_command(*group));
    add(i, words_by_hand(scenario.uavs[i].sut, own.target, group ? group->socket : ""));
  }
  return text;
}

}  // namespace tether::runner
