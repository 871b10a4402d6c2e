#include "time_left.h"

#include <algorithm>
#include <map>
#include <set>

namespace tether::experiment {
namespace {

struct Mean {
  Duration sum{0};
  int count = 0;
  void add(Duration d) {
    sum += d;
    ++count;
  }
  Duration value() const { return sum / count; }
};

}  // namespace

std::optional<Duration> estimate_time_left(std::span<const FinishedTrial> finished,
                                           const std::vector<const TrialPlan*>& side_by_side,
                                           const std::vector<const TrialPlan*>& alone, int jobs) {
  if (finished.empty()) return std::nullopt;
  Mean of_all;
  std::map<const scenario::Condition*, Mean> of_condition;
  std::set<const TrialPlan*> done;
  for (const FinishedTrial& trial : finished) {
    of_all.add(trial.took);
    of_condition[trial.plan->condition].add(trial.took);
    done.insert(trial.plan);
  }
  const auto left_of = [&](const std::vector<const TrialPlan*>& plans) {
    Duration left{0};
    for (const TrialPlan* plan : plans) {
      if (done.contains(plan)) continue;
      const auto known = of_condition.find(plan->condition);
      left += known == of_condition.end() ? of_all.value() : known->second.value();
    }
    return left;
  };
  return left_of(side_by_side) / std::max(1, jobs) + left_of(alone);
}

}  // namespace tether::experiment
