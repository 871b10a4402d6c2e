#include "time_left.h"

#include <map>
#include <set>

namespace tether::campaign {
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
                                           std::span<const Batch> batches) {
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
  Duration left{0};
  for (const Batch& batch : batches) left += left_of(batch.plans) / batch.jobs;
  return left;
}

}  // namespace tether::campaign
