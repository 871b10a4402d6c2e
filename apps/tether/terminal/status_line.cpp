#include "terminal/status_line.h"

#include "terminal/print.h"
#include "terminal/say.h"

#include <cstdio>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include <tether/os/terminal.h>

namespace tether::app {

std::string to_line(const coordinator::RunStatus& status, int columns) {
  if (status.wall == Duration(0))
    return os::cut_to_columns(
        "waiting for " + (status.waiting_for.empty() ? "the SUT to connect" : status.waiting_for),
        columns);
  const double st_s = to_seconds(status.st);
  std::vector<std::string> fields = {fmt::format("ST {:7.3f} s", st_s)};
  if (status.et) {
    fields.push_back(fmt::format("ET {:7.3f} s", to_seconds(*status.et)));
    fields.push_back(fmt::format("lag {:6.1f} ms", to_seconds(lag(*status.et, status.st)) * 1e3));
  }
  fields.push_back(fmt::format("{:5.2f}x real time", st_s / to_seconds(status.wall)));
  if (!status.waiting_for.empty()) fields.push_back(status.waiting_for + " computing");
  fields.push_back(fmt::format("{} interactions", status.interactions));
  fields.push_back(fmt::format("{} frames", status.images));
  return os::fields_in_columns(fields, columns);
}

StatusLine::~StatusLine() {
  clear();
}

void StatusLine::clear() {
  if (shown_) say("{}", os::kClearLine);
  shown_ = false;
}

void StatusLine::print(const std::string& line) {
  clear();
  complain(line);
}

void StatusLine::show(const coordinator::RunStatus& status) {
  if (const int columns = os::terminal_columns(STDERR_FILENO)) show(to_line(status, columns));
}

void StatusLine::show(const std::string& text) {
  const int columns = os::terminal_columns(STDERR_FILENO);
  if (columns == 0) return;
  say("{}{}", os::kClearLine, os::cut_to_columns(text, columns));
  std::fflush(stderr);
  shown_ = true;
}

}  // namespace tether::app
