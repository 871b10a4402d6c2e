#include "terminal/print.h"

#include "terminal/say.h"

#include <fmt/format.h>
#include <unistd.h>

#include <tether/base/text.h>
#include <tether/os/terminal.h>

namespace tether::app {

void print(const std::string& text) {
  fmt::print("{}", wrapped(text, os::text_columns(STDOUT_FILENO)));
}

report::Markup markup_of_stdout() {
  return os::shows_colours(STDOUT_FILENO) ? report::Markup::kTerminal : report::Markup::kPlain;
}

void complain(const std::string& line) {
  const bool is_terminal = os::terminal_columns(STDERR_FILENO) > 0;
  say("{}\n", is_terminal ? wrapped(line, os::text_columns(STDERR_FILENO)) : line);
}

}  // namespace tether::app
