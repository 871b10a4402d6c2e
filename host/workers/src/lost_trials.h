#pragma once

#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <tether/workers/engine.h>
#include <tether/workers/round.h>

namespace tether::workers {

/// Which trials were lost, and why. A trial without a result was lost if a worker says so, or if it
/// is the first one without a result of a chunk whose worker has vanished: workers fly the trials
/// of a chunk in order. The others of the chunk were not begun.
class LostTrials {
 public:
  /// @param name_of for what a person reads.
  explicit LostTrials(std::function<std::string(const std::string& folder)> name_of)
      : name_of_(std::move(name_of)) {}

  /// @param tasks what was last known of the round's tasks.
  /// @param is_cancelled by the user, which no machine is to blame for.
  void add_losses_of(const Round& round, const std::set<std::string>& results,
                     const std::vector<Task>& tasks, bool is_cancelled);
  /// Of the trial with that folder; one line each.
  std::vector<std::string> losses(const std::string& folder) const;
  /// On which trials were lost, or that were refused, in the last round.
  const std::set<std::string>& nodes() const { return nodes_; }
  /// What was lost since the last call.
  std::vector<std::string> take_news() { return std::exchange(news_, {}); }

 private:
  void lose(const Item& item, const std::string& node, const std::string& why);

  std::function<std::string(const std::string&)> name_of_;
  std::map<std::string, std::vector<std::string>> losses_;
  std::set<std::string> nodes_;
  std::vector<std::string> news_;
};

}  // namespace tether::workers
