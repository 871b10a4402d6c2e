#include "as_is.h"
#include "command_line.h"

#include <cstdio>
#include <cstdlib>
#include <exception>

#include <tether/supervisor/supervise.h>
#include <tether/supervisor/supervise_as_is.h>

namespace tether::exec {
namespace {

void say(const std::string& message) {
  std::fprintf(stderr, "tether-exec: %s\n", message.c_str());
}

int run(const std::vector<std::string>& arguments) {
  Parsed parsed = parse_command_line(arguments);
  if (parsed.notice) {
    std::fputs(parsed.notice->text.c_str(), parsed.notice->exit_code == 0 ? stdout : stderr);
    return parsed.notice->exit_code;
  }
  // Inside another tether-exec, the program is stopped by that one.
  const char* const outer = std::getenv("TETHER_EXEC");
  const bool is_inside = outer != nullptr && *outer != 0;
  if (parsed.has_all_processes && !is_inside) {
    if (!is_wall_clock())
      return supervisor::supervise_as_is(parsed.settings.command, library_as_is(), say);
    static_cast<void>(library_as_is());  // or it says that it is missing
    parsed.settings.command.insert(parsed.settings.command.begin(), {"/proc/self/exe", "--as-is"});
  } else if (parsed.is_as_is) {
    say(become_as_is(parsed.settings.command));
    return 2;
  }
  if (const Status good = read_environment(parsed.settings); !good) {
    say(good.failure().message);
    return 2;
  }
  return supervisor::supervise(parsed.settings, say);
}

}  // namespace
}  // namespace tether::exec

int main(int argc, char** argv) {
  try {
    return tether::exec::run({argv + 1, argv + argc});
  } catch (const std::exception& error) {  // the standard library's: no memory
    tether::exec::say(error.what());
    return 3;
  }
}
