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
  char path[4096];
  const ssize_t size = ::readlink("/proc/self/exe", path, sizeof path);
  const std::string_view whole(path, size > 0 ? static_cast<std::size_t>(size) : 0);
  const std::string_view name = whole.substr(whole.rfind('/') + 1);
  for (const std::string_view starter : kStarters)
    if (name == starter) return true;
  return false;
}

// TETHER_AS_IS has the process that tether-exec became, or "group": then all are.
bool is_under_test() {
  const char* const process = std::getenv("TETHER_AS_IS");
  if (process != nullptr && std::string_view(process) == "group") return true;
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
