#include "suts/sut_processes.h"

#include "suts/local_sut.h"
#include "suts/stall_watch.h"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>

#include <tether/os/child_process.h>
#include <tether/os/process_table.h>
#include <tether/os/text_file.h>

namespace tether::runner {

namespace {

/// The command of a SUT on the board. Files of the scenario in its parameters are copied there.
board::BoardSut board_sut(board::Board& board, const scenario::Scenario& scenario,
                          std::size_t index, const SutRun& run, const std::filesystem::path& log) {
  const scenario::UavSetup& uav = scenario.uavs[index];
  scenario::Sut sut = uav.sut;
  for (auto& [key, value] : sut.parameters)
    if (std::binary_search(scenario.files.begin(), scenario.files.end(),
                           std::filesystem::path(value)))
      value = board.copy(value);
  const SutGroup* const group = group_of(run, index);
  SutCommand command =
      sut_command(sut, computer_of(run.condition, index).target, group ? group->socket : "");
  return {.uav = uav.placement.name,
          .words = std::move(command.words),
          .program = command.program,
          .supervisor = command.supervisor,
          .environment = environment_of(uav.placement.name, index, run),
          .log = log};
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
  if (has_local_) os::end_orphans(kOrphanGrace);
}

void SutProcesses::start(const scenario::Scenario& scenario, const SutRun& run,
                         const std::filesystem::path& folder,
                         const std::vector<board::Board*>& boards) {
  for (std::size_t i = 0; i < scenario.uavs.size(); ++i) {
    if (computer_of(run.condition, i).by_hand) continue;
    const scenario::UavSetup& uav = scenario.uavs[i];
    board::Board* const board = boards.empty() ? nullptr : boards[i];
    if (!board && !std::exchange(has_local_, true)) os::adopt_orphans();
    const SutGroup* const group = group_of(run, i);
    if (group && group->uavs.front() == i) start_group(scenario, run, *group, folder, board);
    const std::string& name = uav.placement.name;
    Sut sut{.uav = name,
            .name = fmt::format("the SUT of UAV \"{}\"", name),
            .log = folder / fmt::format("sut-{}.log", name),
            .files = scenario.uavs.size() > 1 ? folder / name : folder,
            .program = {},
            .process = {},
            .board = board,
            .is_as_is = uav.sut.is_as_is,
            .has_all_processes = uav.sut.has_all_processes};
    if (board) {
      const board::BoardSut there = board_sut(*board, scenario, i, run, sut.log);
      sut.program = fmt::format("{} on {}", there.words[there.program],
                                scenario::to_string(board->connection().address()));
      sut.process = board->start(there);
    } else {
      sut.process = std::make_unique<os::ChildProcess>(local_sut(uav, run, i, sut.files, sut.log));
      sut.program = uav.sut.is_as_is ? uav.sut.command.front() : sut.process->program();
    }
    suts_.push_back(std::move(sut));
  }
}

void SutProcesses::start_group(const scenario::Scenario& scenario, const SutRun& run,
                               const SutGroup& group, const std::filesystem::path& folder,
                               board::Board* board) {
  Sut process{.uav = "",
              .name = fmt::format("the group of \"{}\"", group.name),
              .log = folder / fmt::format("exec-{}.log", group.name),
              .files = {},
              .program = "tether-exec",
              .process = {},
              .board = board};
  const std::size_t first = group.uavs.front();
  if (board)
    // No UAV has a space in its name.
    process.process = board->start(
        {.uav = "group " + group.name,
         .words = group_command(group),
         .environment = environment_of(scenario.uavs[first].placement.name, first, run),
         .log = process.log});
  else
    process.process =
        std::make_unique<os::ChildProcess>(local_group(scenario, run, group, process.log));
  suts_.push_back(std::move(process));
}

std::optional<std::string> SutProcesses::early_end() {
  for (Sut& sut : suts_)
    if (sut.process->poll() && !has_ended_well(sut)) return describe_end(sut);
  return std::nullopt;
}

bool SutProcesses::has_failed_to_connect(const std::string& address) {
  return std::ranges::any_of(suts_, [&](const Sut& sut) {
    return sut.process->poll() &&
           os::last_line(os::read_whole(sut.log)).find(address) != std::string::npos;
  });
}

std::string SutProcesses::post_mortem(const std::string& reason, const std::string& lost_uav) {
  std::string lost, others;
  for (Sut& sut : suts_)
    if (sut.process->wait(kEndLimit) && !has_ended_well(sut))
      (sut.uav == lost_uav ? lost : others) += "; " + describe_end(sut, reason);
  return lost + others;
}

std::optional<std::string> SutProcesses::lost() {
  for (const Sut& sut : suts_)
    if (sut.board)
      if (auto why = sut.board->lost()) return why;
  return std::nullopt;
}

std::optional<std::string> SutProcesses::stopped() const {
  for (const Sut& sut : suts_) {
    if (sut.board) continue;
    if (const auto pid = stopped_process(sut.process->pid()))
      return fmt::format("process {} of {} was stopped (by a signal or a debugger)", *pid,
                         sut.name);
  }
  return std::nullopt;
}

// The process of a group ends after its SUTs, which tell why.
bool SutProcesses::has_ended_well(Sut& sut) {
  return sut.uav.empty() && sut.process->poll()->code == 0;
}

std::vector<std::string> SutProcesses::await_exit(
    const std::vector<coordinator::SutReport>& reports) {
  const auto has_reached = [&](const Sut& sut) {
    const auto own = std::ranges::find(reports, sut.uav, &coordinator::SutReport::uav);
    return own != reports.end() && own->finish && own->finish->reached_goal;
  };
  std::vector<std::string> notes;
  for (Sut& sut : suts_)
    if (!sut.process->wait(kExitLimit))
      notes.push_back(fmt::format("{} ({}) did not exit within {} s; it was ended", sut.name,
                                  sut.program, to_seconds(kExitLimit)));
    else if (const int code = sut.process->poll()->code;
             code > os::kSignalled || (code != 0 && has_reached(sut)))
      notes.push_back(describe_end(sut));
  return notes;
}

std::vector<std::string> SutProcesses::bring_back() {
  std::vector<std::string> warnings;
  std::map<board::Board*, bool> has_ended;
  for (const Sut& sut : suts_) {
    if (!sut.board || sut.uav.empty()) continue;
    const auto [ended, is_first] = has_ended.try_emplace(sut.board, false);
    if (is_first) ended->second = sut.board->end_suts();
    if (!ended->second) continue;
    std::filesystem::create_directories(sut.files);
    if (auto warning = sut.board->bring_back(sut.uav, sut.files)) warnings.push_back(*warning);
  }
  return warnings;
}

std::string SutProcesses::describe_end(Sut& sut, const std::string& reason) const {
  const std::string last = os::last_line(os::read_whole(sut.log));
  const os::ChildExit& exit = *sut.process->poll();
  using board::SutEnd;
  const SutEnd end = sut.board ? sut.board->end_of(exit, last) : SutEnd{{}, exit.description};
  const bool is_complete =
      last.empty() || repeats(last, reason) || end.cause == board::SutEndCause::kNotStarted;
  // An end without a finish is a failure, even with the exit code of success. Of several SUTs in a
  // run that began, this one may have finished.
  const bool is_unfinished = exit.code == 0 && (reason.empty() || suts_.size() == 1);
  const char* const missing =
      !is_unfinished || sut.has_all_processes ? ""
      : sut.is_as_is ? " (it never began under the run's clock: a shell script has to start its "
                       "program with 'exec', or needs all_processes = true; a static program "
                       "cannot fly as it is)"
                     : " (it must call tether_connect() and, at its end, tether_finish())";
  return fmt::format(
      "{} ({}) {}{}{}", sut.name, sut.program, end.description, missing,
      is_complete ? "" : fmt::format("; last line of {}: {}", sut.log.string(), last));
}

}  // namespace tether::runner
