#include "options/command_line.h"
#include "terminal/say.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <functional>
#include <new>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

#include <tether/base/error.h>
#include <tether/os/interrupt.h>
#include <tether/runner/trial_server.h>
#include <tether/sim_sdf/world_store.h>

namespace {

using tether::app::say;

/// Opens closed standard streams, so that no other file gets their number and the output. A
/// replaced standard output is read-only: a result that cannot be printed is an error.
void open_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    const int how = stream == STDOUT_FILENO ? O_RDONLY : O_RDWR;
    if (fcntl(stream, F_GETFD) < 0 && open("/dev/null", how) < 0) _exit(3);
  }
}

int fail_to_print(int error_number) {
  say("tether: standard output cannot be written: {}\n", std::strerror(error_number));
  return tether::exit_code(tether::ErrorCode::kSetup);
}

/// The exit code, unless the output could not be written completely.
int end(int code) {
  return std::fflush(stdout) == 0 && !std::ferror(stdout) ? code : fail_to_print(errno);
}

/// Calls `command`, and prints the error with which it ends. @return the exit code.
int with_errors_printed(const std::function<int()>& command) {
  try {
    return end(command());
  } catch (const tether::Error& e) {
    say("tether: {}\n", e.what());
    return tether::exit_code(e.code());
  } catch (const std::bad_alloc&) {
    say("tether: out of memory\n");
    return tether::exit_code(tether::ErrorCode::kSetup);
  } catch (const std::system_error& e) {
    if (std::ferror(stdout)) return fail_to_print(e.code().value());
    say("tether: internal error: {}\n", e.what());
    return tether::exit_code(tether::ErrorCode::kInternal);
  } catch (const std::exception& e) {
    say("tether: internal error: {}\n", e.what());
    return tether::exit_code(tether::ErrorCode::kInternal);
  }
}

int serve_trials() {
  tether::sim::WorldStore worlds;
  return tether::runner::serve_trials(
      {.prepare =
           [&](const std::vector<std::string>& arguments) {
             try {
               tether::app::read_world_ahead(tether::app::parse_run(arguments), worlds);
             } catch (const std::exception&) {  // the trial meets and prints the same one
             }
           },
       .run =
           [&](const std::vector<std::string>& arguments) {
             std::optional<tether::os::Interrupt> interrupt;
             return with_errors_printed([&] {
               tether::app::RunOptions options = tether::app::parse_run(arguments);
               options.worlds = &worlds;
               interrupt.emplace();
               return tether::app::run_one(options, interrupt->token());
             });
           }});
}

}  // namespace

int main(int argc, char** argv) {
  open_standard_streams();
  if (argc == 2 && argv[1] == tether::runner::kServeTrials) return serve_trials();
  std::optional<tether::os::Interrupt> interrupt;  // until everything is printed
  return with_errors_printed([&] { return tether::app::run_command_line(argc, argv, interrupt); });
}
