#include "external/held_program.h"

#include <utility>
#include <vector>

#include <sched.h>
#include <unistd.h>

#include <tether/base/error.h>
#include <tether/os/machine.h>
#include <tether/os/process_table.h>
#include <tether/os/text_file.h>

namespace tether::autopilot {
namespace {

// A program that may set the machine's clock would, to the simulation's time.
os::ChildCommand held(os::ChildCommand command) {
  // The last core that this process may use: others are for programs that are measured.
  if (const std::vector<int> cpus = os::allowed_cpus(); !cpus.empty()) command.cpus = {cpus.back()};
  if (::geteuid() == 0)
    command.arguments.insert(command.arguments.begin(),
                             {"setpriv", "--bounding-set", "-sys_time", "--"});
  command.end_signal = SIGKILL;
  return command;
}

}  // namespace

HeldProgram::HeldProgram(std::string name, os::ChildCommand command)
    : name_(std::move(name)), log_(command.log), process_(held(std::move(command))) {}

void HeldProgram::require_alive() {
  const auto& exit = process_.poll();
  if (!exit) return;
  const std::string line = os::last_line(os::read_whole(log_));
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
    const bool rests = before != at_first && states.runnable + states.on_disk == 0 &&
                       os::turns_of(process_.pid()) == before;
    if (rests) return serve();  // what it has sent since
    if (now() - began > kLimit)
      throw Error(ErrorCode::kHung, name_ +
                                        " has not come to rest for 30 s of real time: it computes "
                                        "without end, or waits for what does not come; see " +
                                        log_.string());
    ::sched_yield();
  }
}

}  // namespace tether::autopilot
