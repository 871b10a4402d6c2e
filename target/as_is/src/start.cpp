// The beginning: when a process is loaded, and is the one that the environment means, it connects.
// Its end is its exit code.

#include "agent.h"
#include "real.h"

#include <array>
#include <cstdlib>
#include <string>
#include <string_view>

#include <pthread.h>
#include <unistd.h>

namespace tether::as_is {
namespace {

// Programs that become others: what they start is under test.
constexpr std::array<std::string_view, 12> kStarters = {"env",    "sh",      "dash",   "bash",
                                                        "nice",   "taskset", "chrt",   "timeout",
                                                        "stdbuf", "time",    "ionice", "setsid"};

bool is_starter() {
  const std::string name = program_name();
  for (const std::string_view starter : kStarters)
    if (name == starter) return true;
  return false;
}

bool is_shell() {
  return program_name().ends_with("sh");
}

// TETHER_AS_IS has the process that tether-exec became, or "group": then all are, as are those of
// a program that is stopped.
bool is_under_test() {
  const char* const process = std::getenv("TETHER_AS_IS");
  if (process != nullptr && std::string_view(process) == "group") return true;
  const char* const socket = std::getenv("TETHER_EXEC");
  if (process != nullptr && socket != nullptr && *socket != 0) return !is_starter() || is_shell();
  return process != nullptr && std::to_string(::getpid()) == process && !is_starter();
}

void on_exit_of_program(int code, void*) {
  const Inside inside;
  if (Agent* const agent = Agent::get(); agent != nullptr && agent->is_here()) agent->finish(code);
}

__attribute__((constructor)) void start_process() {
  if (!is_under_test()) return;
  ::on_exit(on_exit_of_program, nullptr);
  ::pthread_atfork(nullptr, nullptr, &Agent::leave);
  Agent::start();
}

}  // namespace
}  // namespace tether::as_is
