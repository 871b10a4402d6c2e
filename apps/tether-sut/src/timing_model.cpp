#include "timing_model.h"

#include <algorithm>
#include <cstdlib>
#include <string>

namespace tether::sut {
namespace {

using tasks::Acquisition;

constexpr std::size_t kFewestSteps = 3;
constexpr Duration kShortestLiveDelay = std::chrono::milliseconds(5);

Duration median(std::vector<Duration> times) {
  const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
  std::nth_element(times.begin(), middle, times.end());
  return *middle;
}

/// From one sample to the next, for each index.
std::vector<Duration> steps(const SensorTimes& times) {
  std::vector<Duration> all;
  for (const auto& experiment : times.experiments) {
    for (std::size_t i = 1; i < experiment.size(); ++i) {
      const Acquisition& before = experiment[i - 1];
      const Acquisition& after = experiment[i];
      if (after.index > before.index) {
        all.push_back((after.sampled_at - before.sampled_at) /
                      static_cast<std::int64_t>(after.index - before.index));
      }
    }
  }
  return all;
}

std::vector<Duration> delays(const SensorTimes& times) {
  std::vector<Duration> all;
  for (const auto& experiment : times.experiments) {
    for (std::size_t i = 1; i < experiment.size(); ++i) {
      all.push_back(experiment[i].had_at - same_instant(experiment[i].sampled_at));
    }
  }
  return all;
}

/// Three in four within a fifth.
bool is_steady(const std::vector<Duration>& all, Duration middle) {
  const auto near = std::count_if(all.begin(), all.end(), [middle](Duration step) {
    return 5 * std::chrono::abs(step - middle) <= middle;
  });
  return 4 * static_cast<std::size_t>(near) >= 3 * all.size();
}

Failure refuse(const SensorTimes& times, const std::string& why) {
  return {Failure::Kind::kInvalid,
          "sensor \"" + times.sensor + "\": " + why + "; use --timing on_demand"};
}

}  // namespace

TimingModel on_demand_timing(const SensorTimes& times) {
  return {std::nullopt, times.taken()};
}

Result<TimingModel> periodic_timing(const SensorTimes& times, bool may_stamp_arrival) {
  const std::vector<Duration> all_steps = steps(times);
  if (all_steps.size() < kFewestSteps) {
    return refuse(times, "too few samples to tell its period");
  }
  const Duration period = median(all_steps);
  if (period <= Duration::zero() || !is_steady(all_steps, period)) {
    return refuse(times, "its samples come too irregularly to tell a period");
  }
  TimingModel model{period, delays(times)};
  const Duration shortest = may_stamp_arrival ? kShortestLiveDelay : Duration::zero();
  if (median(model.delays) < shortest ||
      *std::min_element(model.delays.begin(), model.delays.end()) < Duration::zero()) {
    return refuse(times,
                  "the device gives no instants of its own, it seems, only those of arrival");
  }
  return model;
}

}  // namespace tether::sut
