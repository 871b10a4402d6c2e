#include "shutdown.h"

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include <signal.h>

namespace tether::gazebo_plugin {
namespace {

constexpr std::chrono::seconds kPatience{5};

// gzserver itself always exits with 0.
void end_with_failure() {
  std::fflush(nullptr);
  std::_Exit(EXIT_FAILURE);
}

// False until gzserver runs its worlds.
bool handles_interrupts() {
  struct sigaction now {};
  return ::sigaction(SIGINT, nullptr, &now) == 0 && now.sa_handler != SIG_DFL;
}

void watch(int code) {
  std::this_thread::sleep_for(kPatience);
  std::fflush(nullptr);
  std::_Exit(code);
}

}  // namespace

void shut_down(const std::string& wrong) {
  static std::atomic<bool> begun{false};
  if (begun.exchange(true)) return;
  const int code = wrong.empty() ? EXIT_SUCCESS : EXIT_FAILURE;
  if (!wrong.empty()) {
    std::fprintf(stderr, "tether: %s\n", wrong.c_str());
    std::atexit(end_with_failure);
  }
  if (!handles_interrupts()) std::_Exit(code);
  std::thread(watch, code).detach();
  ::raise(SIGINT);
}

}  // namespace tether::gazebo_plugin
