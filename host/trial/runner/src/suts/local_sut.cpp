#include "suts/local_sut.h"

#include <algorithm>
#include <sstream>
#include <utility>

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/base/text.h>
#include <tether/os/child_process.h>
#include <tether/os/counted_program.h>
#include <tether/os/machine.h>

namespace tether::runner {

namespace {

/// The program of a SUT with a launcher, as an absolute path unless it is given with a folder.
std::filesystem::path find_launched(const std::string& program, const scenario::Target& target) {
  std::error_code ignored;
  if (program.find('/') == std::string::npos) return os::find_program(program);
  if (std::filesystem::is_regular_file(program, ignored)) return program;
  throw Error(ErrorCode::kSetup, {target.file.string()},
              fmt::format("target \"{}\": the program {} does not exist", target.name, program))
      .about(program);
}

/// The launcher of a target. @throws Error(kBadFile) at the target's file.
std::filesystem::path find_launcher(const std::string& program,
                                    const scenario::Target& target) try {
  return target.emulator ? os::find_emulator(*target.emulator) : os::find_program(program);
} catch (const Error& e) {
  const std::string key = target.emulator ? "emulator" : "launcher";
  throw Error(ErrorCode::kBadFile, target.where(key), fmt::format("'{}': {}", key, e.what()))
      .about(key);
}

/// Creates the folder; returns its absolute path.
std::string files_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw Error(ErrorCode::kSetup, {folder.string()}, error.message());
  return std::filesystem::absolute(folder).lexically_normal().string();
}

/// How many CPUs the SUTs before this one have. Those of one real board have the same ones.
std::size_t first_cpu(const scenario::Condition& condition, std::size_t uav) {
  const auto boards = real_boards(condition, condition.seats.size());
  const auto has_own = [&](std::size_t sut) {
    return std::ranges::none_of(boards, [sut](const scenario::RealBoard& board) {
      return board.uavs.front() != sut && std::ranges::count(board.uavs, sut) > 0;
    });
  };
  std::size_t cpus = 0;
  for (std::size_t other = 0; other < uav; ++other)
    if (const auto& target = computer_of(condition, other).target;
        target && !target->ssh && has_own(other))
      cpus += static_cast<std::size_t>(target->cores);
  return cpus;
}

std::vector<int> cpus_of(const scenario::Condition& condition, std::size_t uav) {
  const auto& target = computer_of(condition, uav).target;
  return cpus_for(os::allowed_cpus(), target ? target->cores : 0, first_cpu(condition, uav));
}

bool is_started_here(const scenario::Computer& own) {
  return !own.by_hand && !(own.target && own.target->ssh);
}

/// Its counts are in this machine's memory, so that it runs here, whoever starts it.
bool is_counted(const scenario::Computer& own) {
  return own.target && own.target->emulator;
}

/// The emulator lists a model in each line: "x86 max   (description)", "  cortex-a53".
void require_cpu_model(const scenario::Target& target) {
  const std::string& wanted = target.emulator->cpu_model;
  if (wanted.empty()) return;
  constexpr Duration kLimit = std::chrono::seconds(10);
  const os::Captured list =
      os::run_captured({target.emulator->program, "-cpu", "help"}, "", kLimit);
  const std::string model = wanted.substr(0, wanted.find(','));  // features follow
  std::istringstream words(list.out);
  std::vector<std::string> models;
  for (std::string word; words >> word;) models.push_back(word);
  if (models.empty() || std::ranges::count(models, model) > 0) return;
  const std::vector<std::string_view> known(models.begin(), models.end());
  const std::string_view near = nearest(model, known);
  throw Error(ErrorCode::kBadFile, target.where("cpu_model"),
              fmt::format("'cpu_model' is \"{}\", which {} does not have{} `{} -cpu help` lists "
                          "its models",
                          wanted, target.emulator->program,
                          near.empty() ? "." : fmt::format("; did you mean \"{}\"?", near),
                          target.emulator->program))
      .about("cpu_model");
}

void require_cores(const scenario::Scenario& scenario, const scenario::Condition& condition) {
  const std::size_t allowed = os::allowed_cpus().size(), suts = scenario.uavs.size();
  if (first_cpu(condition, suts) <= allowed) return;
  for (std::size_t uav = 0; uav < suts; ++uav)
    if (const auto& target = computer_of(condition, uav).target; target && target->cores > 0)
      throw Error(
          ErrorCode::kBadFile, target->where("cores"),
          fmt::format("'cores' is {}{}, but this process may use only {} of this machine. "
                      "Lower it, or use a machine with more cores",
                      target->cores, suts == 1 ? "" : fmt::format(" for each of {} SUTs", suts),
                      counted(allowed, "core")))
          .about("cores");
}

}  // namespace

LocalSutCommand local_sut_command(const scenario::Sut& sut,
                                  const std::optional<scenario::Target>& target,
                                  const std::string& group) {
  auto [words, program_at, supervisor] = sut_command(sut, target, group);
  const bool is_launched = target && !target->launcher.empty();
  std::string& program = words[program_at];
  const auto file = is_launched ? find_launched(program, *target) : os::find_program(program);
  if (sut.is_as_is) os::require_preloadable(file);
  LocalSutCommand command{{}, {}};
  if (program_at > 0) {
    // tether-exec and launchers search for it in PATH only.
    program = file.string();
    if (target && target->emulator) {
      os::require_emulated(*target->emulator, file);
      words.front() = find_launcher(words.front(), *target).string();
    }
    if (supervisor > 0) command.programs.push_back(os::find_program(words.front()));
    if (is_launched) command.programs.push_back(find_launcher(words[supervisor], *target));
  }
  command.programs.push_back(file);
  command.words = std::move(words);
  return command;
}

std::vector<int> cpus_for(const std::vector<int>& allowed, int cores, std::size_t taken) {
  const std::size_t count = static_cast<std::size_t>(cores);
  if (taken + count > allowed.size()) return {};
  return {allowed.rbegin() + static_cast<std::ptrdiff_t>(taken),
          allowed.rbegin() + static_cast<std::ptrdiff_t>(taken + count)};
}

std::vector<std::filesystem::path> sut_programs(const scenario::Scenario& scenario,
                                                const scenario::Condition& condition,
                                                bool by_user) {
  std::vector<std::filesystem::path> programs;
  bool needs_plugin = false;
  std::vector<std::string> groups(scenario.uavs.size());
  for (const scenario::RealBoard& board : real_boards(condition, scenario.uavs.size()))
    for (const std::size_t uav : board.uavs) groups[uav] = board.name;
  for (std::size_t i = 0; i < scenario.uavs.size(); ++i) {
    const scenario::UavSetup& uav = scenario.uavs[i];
    const scenario::Computer& own = computer_of(condition, i);
    if (!is_counted(own) && (by_user || !is_started_here(own))) continue;
    needs_plugin = needs_plugin || is_counted(own);
    try {
      for (const auto& program : local_sut_command(uav.sut, own.target, groups[i]).programs)
        if (std::find(programs.begin(), programs.end(), program) == programs.end())
          programs.push_back(program);
    } catch (const Error& e) {
      if (e.code() == ErrorCode::kBadFile) throw;  // at the target's file
      throw Error(ErrorCode::kBadFile, scenario.where("command"),
                  fmt::format("the SUT of UAV \"{}\": {}", uav.placement.name, e.what()))
          .about(uav.placement.name);
    }
  }
  if (needs_plugin) programs.push_back(os::find_counter_plugin());
  return programs;
}

void try_suts(const scenario::Scenario& scenario, const scenario::Condition& condition,
              bool by_user) {
  constexpr Duration kLimit = std::chrono::seconds(10);
  constexpr int kWrongUse = 2;
  for (std::size_t i = 0; i < scenario.uavs.size(); ++i) {
    const std::string& name = scenario.uavs[i].placement.name;
    const scenario::Sut& sut = scenario.uavs[i].sut;
    const scenario::Computer& own = computer_of(condition, i);
    if (is_counted(own)) require_cpu_model(*own.target);
    const bool is_shipped = std::filesystem::path(sut.command.front()).filename() == "tether-sut";
    if (by_user || !is_shipped || !is_started_here(own)) continue;
    scenario::Sut alone = sut;
    alone.concurrent = false;
    LocalSutCommand command = local_sut_command(alone, own.target);
    if (command.programs.size() == 1) command.words.front() = command.programs.front().string();
    command.words.emplace_back("--check");
    for (const std::string& anchor : scenario.anchors)
      command.words.insert(command.words.end(), {"--anchors", anchor});
    const os::Captured checked = os::run_captured(command.words, "", kLimit);
    if (checked.code != kWrongUse) continue;
    throw Error(ErrorCode::kBadFile, scenario.where("command"),
                fmt::format("the SUT of UAV \"{}\" cannot fly this: {}", name,
                            checked.err.substr(0, checked.err.find('\n'))))
        .about(name);
  }
}

void require_sut_programs(const scenario::Scenario& scenario, const scenario::Condition& condition,
                          bool by_user) {
  sut_programs(scenario, condition, by_user);
  if (by_user) return;
  for (std::size_t uav = 0; uav < scenario.uavs.size(); ++uav)
    if (is_started_here(computer_of(condition, uav))) return require_cores(scenario, condition);
}

os::ChildCommand local_sut(const scenario::UavSetup& uav, const SutRun& run, std::size_t index,
                           const std::filesystem::path& out, const std::filesystem::path& log) {
  const SutGroup* const group = group_of(run, index);
  auto environment = environment_of(uav.placement.name, index, run);
  environment.emplace_back("TETHER_OUT", files_folder(out));
  const scenario::Computer& own = computer_of(run.condition, index);
  os::ChildCommand command{
      .arguments = local_sut_command(uav.sut, own.target, group ? group->socket : "").words,
      .environment = std::move(environment),
      .log = log,
      .cpus = cpus_of(run.condition, index),
      // Or what it started before it connected would not be known to it.
      .adopts_orphans = own.clock.kind == computer::ClockKind::kCpu ||
                        own.clock.kind == computer::ClockKind::kCounted};
  if (is_counted(own)) os::pad_start(command);
  return command;
}

os::ChildCommand local_group(const scenario::Scenario& scenario, const SutRun& run,
                             const SutGroup& group, const std::filesystem::path& log) {
  const std::size_t first = group.uavs.front();
  return {.arguments = group_command(group),
          .environment = environment_of(scenario.uavs[first].placement.name, first, run),
          .log = log,
          .cpus = cpus_of(run.condition, first)};
}

}  // namespace tether::runner
