#include "options/command_line.h"
#include "terminal/say.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <optional>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

#include <tether/base/error.h>
#include <tether/os/interrupt.h>

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

}  // namespace

int main(int argc, char** argv) {
  open_standard_streams();
  std::optional<tether::os::Interrupt> interrupt;  // until everything is printed
  try {
    return end(tether::app::run_command_line(argc, argv, interrupt));
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
