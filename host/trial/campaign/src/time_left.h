#pragma once

#include <optional>
#include <span>

#include <tether/campaign/campaign_plan.h>

namespace tether::campaign {

struct FinishedTrial {
  const TrialPlan* plan = nullptr;
  Duration took{0};
};

/// Wall time until the last trial ends: each unfinished trial takes the mean of its scenario and
/// condition so far (of all trials, if that has none yet), divided by the jobs of its batch. None
/// until a trial has finished.
std::optional<Duration> estimate_time_left(std::span<const FinishedTrial> finished,
                                           std::span<const Batch> batches);

}  // namespace tether::campaign
