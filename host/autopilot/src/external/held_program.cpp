#include "external/held_program.h"

#include <algorithm>
#include <fstream>
#include <utility>

#include <sched.h>
#include <unistd.h>

#include <tether/base/error.h>
#include <tether/os/clock.h>
#include <tether/os/process_table.h>

namespace tether::autopilot {
namespace {

/// The last core that this process may use: others are for programs that are measured.
int last_core() {
  cpu_set_t set;
  CPU_ZERO(&set);
  ::sched_getaffinity(0, sizeof set, &set);
  int last = 0;
  for (std::size_t core = 0; core < CPU_SETSIZE; ++core)
    if (CPU_ISSET(core, &set)) last = static_cast<int>(core);
  return last;
}

// A program that may set the machine's clock would, to the simulation's time.
os::ChildCommand held(os::ChildCommand command) {
  command.cpus = {last_core()};
  if (::geteuid() == 0)
    command.arguments.insert(command.arguments.begin(),
                             {"setpriv", "--bounding-set", "-sys_time", "--"});
  command.end_signal = SIGKILL;
  return command;
}

std::string last_line_of(const std::filesystem::path& log) {
  std::ifstream file(log);
  std::string last;
  for (std::string line; std::getline(file, line);)
    if (line.find_first_not_of(" \t\r") != std::string::npos) last = line;
  return last;
}

}  // namespace

HeldProgram::HeldProgram(std::string name, os::ChildCommand command)
    : name_(std::move(name)), log_(command.log), process_(held(std::move(command))) {}

void HeldProgram::require_alive() {
  const auto& exit = process_.poll();
  if (!exit) return;
  const std::string line = last_line_of(log_);
  throw Error(ErrorCode::kLinkLost, name_ + " " + exit->description +
                                        (line.empty() ? "" : ": \"" + line + "\"") + "; see " +
                                        log_.string());
}

// On a busy machine, what was sent may wake its thread some time later only.
void HeldProgram::let_rest(const std::function<void()>& send, const std::function<void()>& serve) {
  constexpr Duration kLimit = std::chrono::seconds(30);
  const auto now = [] { return os::read_clock(CLOCK_MONOTONIC); };
  const Duration began = now();
  const std::uint64_t at_first = os::turns_of(process_.pid());
  send();
  for (;;) {
    serve();
    require_alive();
    const std::uint64_t before = os::turns_of(process_.pid());
    const os::ThreadStates states = os::thread_states(process_.pid());
    if (before != at_first && states.runnable + states.on_disk == 0 &&
        os::turns_of(process_.pid()) == before)
      return;
    if (now() - began > kLimit)
      throw Error(ErrorCode::kHung, name_ +
                                        " has not come to rest for 30 s of real time: it computes "
                                        "without end, or waits for what does not come; see " +
                                        log_.string());
    ::sched_yield();
  }
}

}  // namespace tether::autopilot
