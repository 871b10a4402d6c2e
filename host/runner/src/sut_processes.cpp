#include "sut_processes.h"

#include "local_sut.h"
#include "stall_watch.h"

#include <algorithm>
#include <fstream>

#include <fmt/format.h>

#include <tether/os/child_process.h>
#include <tether/os/process_table.h>

namespace tether::runner {

namespace {

/// The command of a SUT on the board. Files of the scenario in its parameters are copied there.
board::BoardSut board_sut(board::Board& board, const scenario::Scenario& scenario,
                          const scenario::UavSetup& uav, const SutRun& run,
                          const std::filesystem::path& log) {
  scenario::Sut sut = uav.sut;
  for (auto& [key, value] : sut.parameters)
    if (std::binary_search(scenario.files.begin(), scenario.files.end(),
                           std::filesystem::path(value)))
      value = board.copy(value);
  SutCommand command = sut_command(sut, run.condition.target);
  return {.uav = uav.placement.name,
          .words = std::move(command.words),
          .program = command.program,
          .concurrent = sut.concurrent,
          .environment = environment_of(uav.placement.name, 0, run),
          .log = log};
}

/// The last line that is not empty; empty if there is none.
std::string last_line(const std::filesystem::path& file) {
  std::ifstream log(file);
  std::string last;
  for (std::string line; std::getline(log, line);)
    if (!line.empty()) last = line;
  return last;
}

// How long a finished SUT may take to exit.
constexpr Duration kExitLimit = std::chrono::seconds(2);
// How long the process of a lost SUT may take to end after its connection.
constexpr Duration kEndLimit = std::chrono::milliseconds(200);
// How long the processes that local SUTs leave behind may take to end.
constexpr Duration kOrphanGrace = std::chrono::seconds(1);

/// A program that prints the error of its call ends its output with what it has reported itself.
bool repeats(const std::string& output, const std::string& reason) {
  constexpr std::string_view kBeforeMessage = ": ";
  const auto at = reason.find(kBeforeMessage);
  return at != std::string::npos && output.ends_with(reason.substr(at + kBeforeMessage.size()));
}

}  // namespace

SutProcesses::~SutProcesses() {
  if (suts_.empty()) return;
  suts_.clear();
  if (!board_) os::end_orphans(kOrphanGrace);
}

void SutProcesses::start(const scenario::Scenario& scenario, const SutRun& run,
                         const std::filesystem::path& folder, board::Board* board) {
  board_ = board;
  if (!board) os::adopt_orphans();
  for (const scenario::UavSetup& uav : scenario.uavs) {
    const std::string& name = uav.placement.name;
    Sut sut{.uav = name,
            .log = folder / fmt::format("sut-{}.log", name),
            .files = scenario.uavs.size() > 1 ? folder / name : folder,
            .program = {},
            .process = {}};
    if (board) {
      const board::BoardSut there = board_sut(*board, scenario, uav, run, sut.log);
      sut.program = fmt::format("{} on {}", there.words[there.program],
                                scenario::to_string(board->connection().address()));
      sut.process = board->start(there);
    } else {
      sut.process =
          std::make_unique<os::ChildProcess>(local_sut(uav, run, suts_.size(), sut.files, sut.log));
      sut.program = sut.process->program();
    }
    suts_.push_back(std::move(sut));
  }
}

std::optional<std::string> SutProcesses::early_end() {
  for (Sut& sut : suts_)
    if (sut.process->poll()) return describe_end(sut);
  return std::nullopt;
}

bool SutProcesses::has_failed_to_connect(const std::string& address) {
  return std::ranges::any_of(suts_, [&](const Sut& sut) {
    return sut.process->poll() && last_line(sut.log).find(address) != std::string::npos;
  });
}

std::string SutProcesses::post_mortem(const std::string& reason) {
  std::string text;
  for (Sut& sut : suts_)
    if (sut.process->wait(kEndLimit)) text += "; " + describe_end(sut, reason);
  return text;
}

std::optional<std::string> SutProcesses::lost() {
  return board_ ? board_->lost() : std::nullopt;
}

std::optional<std::string> SutProcesses::stopped() const {
  if (board_) return std::nullopt;
  for (const Sut& sut : suts_)
    if (const auto pid = stopped_process(sut.process->pid()))
      return fmt::format(
          "process {} of the SUT of UAV \"{}\" was stopped (by a signal or a debugger)", *pid,
          sut.uav);
  return std::nullopt;
}

std::vector<std::string> SutProcesses::await_exit() {
  std::vector<std::string> notes;
  for (Sut& sut : suts_)
    if (!sut.process->wait(kExitLimit))
      notes.push_back(fmt::format(
          "the SUT of UAV \"{}\" ({}) had finished but did not exit within {} s; it was "
          "ended",
          sut.uav, sut.program, to_seconds(kExitLimit)));
    else if (sut.process->poll()->code > os::kSignalled)
      notes.push_back("after it had finished: " + describe_end(sut));
  return notes;
}

std::vector<std::string> SutProcesses::bring_back() {
  std::vector<std::string> warnings;
  if (!board_ || !board_->end_suts()) return warnings;
  for (const Sut& sut : suts_) {
    std::filesystem::create_directories(sut.files);
    if (auto warning = board_->bring_back(sut.uav, sut.files)) warnings.push_back(*warning);
  }
  return warnings;
}

std::string SutProcesses::describe_end(Sut& sut, const std::string& reason) const {
  const std::string last = last_line(sut.log);
  const os::ChildExit& exit = *sut.process->poll();
  using board::SutEnd;
  const SutEnd end = board_ ? board_->end_of(exit, last) : SutEnd{{}, exit.description};
  const bool is_complete =
      last.empty() || repeats(last, reason) || end.cause == board::SutEndCause::kNotStarted;
  return fmt::format(
      "the SUT of UAV \"{}\" ({}) {}{}", sut.uav, sut.program, end.description,
      is_complete ? "" : fmt::format("; last line of {}: {}", sut.log.string(), last));
}

}  // namespace tether::runner
