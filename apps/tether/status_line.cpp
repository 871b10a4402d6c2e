#include "status_line.h"

#include "say.h"

#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

namespace tether::app {

std::string to_line(const coordinator::RunStatus& status) {
  if (status.wall == Duration(0))
    return fmt::format("waiting for {}",
                       status.waiting_for.empty() ? "the SUT to connect" : status.waiting_for);
  const double st_s = to_seconds(status.st);
  const std::string et =
      status.et ? fmt::format("   ET {:7.3f} s   lag {:6.1f} ms", to_seconds(*status.et),
                              to_seconds(lag(*status.et, status.st)) * 1e3)
                : "";
  return fmt::format("ST {:7.3f} s{}   {:5.2f}x real time   {} frames   {} interactions{}", st_s,
                     et, st_s / to_seconds(status.wall), status.images, status.interactions,
                     status.waiting_for.empty() ? "" : "   " + status.waiting_for + " computing");
}

StatusLine::StatusLine() : is_terminal_(isatty(STDERR_FILENO) == 1) {}

StatusLine::~StatusLine() {
  clear();
}

void StatusLine::clear() {
  if (shown_) say("\r\x1b[K");
  shown_ = false;
}

void StatusLine::print(const std::string& line) {
  clear();
  say("{}\n", line);
}

void StatusLine::show(const std::string& line) {
  if (!is_terminal_) return;
  say("\r\x1b[K{}", line);
  std::fflush(stderr);
  shown_ = true;
}

}  // namespace tether::app
