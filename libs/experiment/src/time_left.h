#pragma once

#include <optional>
#include <span>
#include <vector>

#include <tether/experiment/campaign_plan.h>

namespace tether::experiment {

struct FinishedTrial {
  const TrialPlan* plan = nullptr;
  Duration took{0};
};

/// Wall time until the last trial ends: each unfinished one as long as the mean of its scenario
/// and condition so far (of all, where that has none yet), those side by side shared out among
/// the jobs. None until a trial has finished.
std::optional<Duration> estimate_time_left(std::span<const FinishedTrial> finished,
                                           const std::vector<const TrialPlan*>& side_by_side,
                                           const std::vector<const TrialPlan*>& alone, int jobs);

}  // namespace tether::experiment
