#include "terminal/errors_printed.h"

#include "terminal/print.h"
#include "terminal/say.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <system_error>

#include <tether/base/error.h>

namespace tether::app {

namespace {

int fail_to_print(int error_number) {
  say("tether: standard output cannot be written: {}\n", std::strerror(error_number));
  return exit_code(ErrorCode::kSetup);
}

/// The exit code, unless the output could not be written completely.
int end(int code) {
  return std::fflush(stdout) == 0 && !std::ferror(stdout) ? code : fail_to_print(errno);
}

}  // namespace

int with_errors_printed(const std::function<int()>& command) {
  try {
    return end(command());
  } catch (const Error& e) {
    complain(std::string("tether: ") + e.what());
    return exit_code(e.code());
  } catch (const std::bad_alloc&) {
    say("tether: out of memory\n");
    return exit_code(ErrorCode::kSetup);
  } catch (const std::system_error& e) {
    if (std::ferror(stdout)) return fail_to_print(e.code().value());
    say("tether: internal error: {}\n", e.what());
    return exit_code(ErrorCode::kInternal);
  } catch (const std::exception& e) {
    say("tether: internal error: {}\n", e.what());
    return exit_code(ErrorCode::kInternal);
  }
}

}  // namespace tether::app
