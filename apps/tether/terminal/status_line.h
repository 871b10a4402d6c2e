#pragma once

#include <string>

#include <tether/base/time.h>
#include <tether/coordinator/coordinator.h>

namespace tether::app {

/// The status as one line of a terminal with that many columns: ST, ET, lag, real-time factor, the
/// SUT that computes, interactions, frames; as many of them as fit.
std::string to_line(const coordinator::RunStatus& status, int columns);

/// A line on stderr that is overwritten with each status and fits the terminal's present width;
/// nothing if stderr is not a terminal.
class StatusLine {
 public:
  StatusLine() = default;
  /// Clears it.
  ~StatusLine();
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;

  void show(const coordinator::RunStatus& status);
  void show(const std::string& text);
  void clear();
  /// Prints a permanent line, on a terminal or not.
  void print(const std::string& line);

 private:
  bool shown_ = false;
};

}  // namespace tether::app
