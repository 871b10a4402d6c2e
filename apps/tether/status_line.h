#pragma once

#include <string>

#include <tether/base/time.h>
#include <tether/coordinator/coordinator.h>

namespace tether::app {

/// The status in one line: ST, ET, lag, real-time factor, frames, and the SUT that computes.
std::string to_line(const coordinator::RunStatus& status);

/// A line on stderr that is overwritten with each status; nothing if stderr is not a terminal.
class StatusLine {
 public:
  StatusLine();
  /// Clears it.
  ~StatusLine();
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;

  void show(const std::string& line);
  /// Prints a permanent line, on a terminal or not.
  void print(const std::string& line);

 private:
  void clear();

  bool is_terminal_;
  bool shown_ = false;
};

}  // namespace tether::app
