#pragma once

#include <chrono>
#include <string>

namespace tether::sut {

/// The present activity on stderr: on a terminal a line that is overwritten, otherwise a line at
/// most every ten seconds.
class ProgressLine {
 public:
  ProgressLine();
  /// Clears it.
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void show(const std::string& what);

 private:
  bool is_shown_ = false;
  std::chrono::steady_clock::time_point last_;
};

}  // namespace tether::sut
