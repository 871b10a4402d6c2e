
#include <signal.h>
#include <time.h>
#include <unistd.h>

#include <tether/os/interrupt.h>

namespace tether::os {

namespace {

// Terminals and supervisors may send one interrupt twice in a row; a person who means it comes
// later.
constexpr long kSecondThoughts_ms = 500;

volatile sig_atomic_t g_interrupted = 0;
timespec g_first_at{};

extern "C" void on_signal(int signal_number) {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  if (g_interrupted) {
    const long elapsed_ms =
        (now.tv_sec - g_first_at.tv_sec) * 1000 + (now.tv_nsec - g_first_at.tv_nsec) / 1'000'000;
    if (elapsed_ms > kSecondThoughts_ms) _exit(128 + signal_number);
    return;
  }
  g_first_at = now;
  g_interrupted = 1;
}

}  // namespace

void catch_interrupts() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  signal(SIGPIPE, SIG_IGN);
  signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is a reason like a full disk
}

bool interrupted() {
  return g_interrupted != 0;
}

}  // namespace tether::os
