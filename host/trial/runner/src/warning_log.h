#pragma once

#include <functional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <tether/base/error.h>

namespace tether::runner {

/// Collects warnings, each once. Not thread-safe.
class WarningLog {
 public:
  using Observer = std::function<void(const std::vector<Warning>&)>;
  explicit WarningLog(Observer observer) : observer_(std::move(observer)) {}

  /// @pre the log lives as long as the sink is used
  WarningSink sink() {
    return [this](const Warning& warning) { add(warning); };
  }
  /// Passes on what was collected, and from now on each warning at once.
  void pass_on() {
    is_passing_on_ = true;
    if (observer_ && !all_.empty()) observer_(all_);
  }
  const std::vector<Warning>& all() const { return all_; }

 private:
  void add(const Warning& warning) {
    if (!lines_.insert(to_line(warning)).second) return;
    all_.push_back(warning);
    if (observer_ && is_passing_on_) observer_({warning});
  }

  Observer observer_;
  std::vector<Warning> all_;
  std::set<std::string> lines_;
  bool is_passing_on_ = false;
};

}  // namespace tether::runner
