#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <tether/coordinator/coordinator.h>
#include <tether/os/child_process.h>
#include <tether/os/counted_program.h>
#include <tether/scenario/scenario.h>

/// The command line and the environment of a SUT, on this machine or a board.
namespace tether::runner {

/// The SUTs of a real board, which run in one group of tether-exec.
struct SutGroup {
  std::string name;               ///< of the board
  std::vector<std::size_t> uavs;  ///< in order
  std::string socket;             ///< path on the board
};

/// The run that a SUT joins.
struct SutRun {
  std::string address;  ///< of the coordinator, host:port
  std::string token;
  scenario::Condition condition;
  std::map<std::size_t, os::CountFile> counts{};   ///< of SUTs with the clock "counted", by index
  std::map<std::size_t, std::string> addresses{};  ///< for SUTs on boards instead, by index
  std::vector<SutGroup> groups{};
};
/// That of a SUT; null: it has none.
const SutGroup* group_of(const SutRun& run, std::size_t uav);

/// The SUT's program with its parameters as options: max_frames = 5 becomes --max-frames 5.
std::vector<std::string> command_line(const scenario::Sut& sut);
/// A SUT's command line, and the index of its program in it.
struct SutCommand {
  std::vector<std::string> words;
  std::size_t program = 0;
  std::size_t supervisor = 0;  ///< how many words of tether-exec it starts with
};
/// The command line on a target: the target's launcher, then the program in the target's folder;
/// under tether-exec if the SUT is concurrent, or belongs to the group at the socket `group`. Reads
/// no file.
SutCommand sut_command(const scenario::Sut& sut, const std::optional<scenario::Target>& target,
                       const std::string& group = "");
/// The command line of a group's own process.
std::vector<std::string> group_command(const SutGroup& group);
/// The environment with which the client library joins the SUT of that UAV, the run's SUT with that
/// index, to the run.
os::Environment environment_of(const std::string& uav, std::size_t index, const SutRun& run);

/// For a user who starts SUTs: the command line of each, with its environment. `all`: of every SUT,
/// not only of those on computers whose SUTs are started by hand.
std::string sut_instructions(const scenario::Scenario& scenario, const SutRun& run,
                             bool all = true);

}  // namespace tether::runner
