#pragma once

#include <chrono>
#include <string>

namespace tether::sut {

/// What goes on at the moment, on stderr: on a terminal one line that is written over itself;
/// elsewhere a line at most every ten seconds, so that what takes long can be told from what hangs.
class ProgressLine {
 public:
  ProgressLine();
  /// Clears it.
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void show(const std::string& what);

 private:
  bool is_terminal_;
  bool is_shown_ = false;
  std::chrono::steady_clock::time_point last_;
};

}  // namespace tether::sut
