#include "commands/trial_service.h"
#include "options/command_line.h"
#include "terminal/errors_printed.h"

#include <optional>

#include <fcntl.h>
#include <unistd.h>

#include <tether/os/interrupt.h>
#include <tether/sim_sdf/load_world.h>

namespace {

/// Opens closed standard streams, so that no other file gets their number and the output. A
/// replaced standard output is read-only: a result that cannot be printed is an error.
void open_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    const int how = stream == STDOUT_FILENO ? O_RDONLY : O_RDWR;
    if (fcntl(stream, F_GETFD) < 0 && open("/dev/null", how) < 0) _exit(3);
  }
}

int serve_trials() {
  tether::sim::WorldStore worlds(tether::sim::FileCache::of_user());
  return tether::runner::serve_trials(tether::app::trial_service(worlds));
}

}  // namespace

int main(int argc, char** argv) {
  open_standard_streams();
  if (argc == 2 && argv[1] == tether::runner::kServeTrials) return serve_trials();
  std::optional<tether::os::Interrupt> interrupt;  // until everything is printed
  return tether::app::with_errors_printed(
      [&] { return tether::app::run_command_line(argc, argv, interrupt); });
}
