#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <tether/base/time.h>

namespace tether::supervisor {

/// What stopping costs, for `--verbose`.
class Statistics {
 public:
  void froze(Duration took) { freezes_.push_back(took); }
  void thawed(Duration took) { thaws_.push_back(took); }
  /// ET at the stop, less the instant at which a reply was due.
  void overshot(Duration by) { overshoots_.push_back(by); }

  /// A few lines for a person.
  std::string report(Duration execution_time) const;

 private:
  std::vector<Duration> freezes_, thaws_, overshoots_;
};

}  // namespace tether::supervisor
