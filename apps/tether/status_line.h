#pragma once

#include <string>

#include <tether/base/time.h>
#include <tether/coordinator/coordinator.h>

namespace tether::app {

/// The status in one line: ST, ET, lag, real-time factor, frames, and whom everything waits for.
std::string to_line(const coordinator::RunStatus& status);

/// One line on stderr that is written over itself; silent where stderr is not a terminal.
class StatusLine {
 public:
  StatusLine();
  /// Clears it.
  ~StatusLine();
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;

  void show(const std::string& line);
  /// A line that stays, terminal or not.
  void leave(const std::string& line);

 private:
  void clear();

  bool is_terminal_;
  bool shown_ = false;
};

}  // namespace tether::app
