#pragma once

#include <optional>
#include <span>

#include <tether/campaign/campaign_plan.h>

namespace tether::campaign {

struct FinishedTrial {
  const TrialPlan* plan = nullptr;
  Duration took{0};
};

/// Wall time until the last trial ends: each unfinished one as long as the mean of its scenario
/// and condition so far (of all, where that has none yet), shared out among the jobs of its batch.
/// None until a trial has finished.
std::optional<Duration> estimate_time_left(std::span<const FinishedTrial> finished,
                                           std::span<const Batch> batches);

}  // namespace tether::campaign
