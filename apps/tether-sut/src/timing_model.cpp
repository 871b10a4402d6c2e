#include "timing_model.h"

#include <algorithm>
#include <string>
#include <utility>

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

/// From one sample to the next; more than one index, if samples were missed.
struct Step {
  Duration span;
  std::int64_t indices = 1;

  Duration of_one() const { return span / indices; }
};

std::vector<Step> steps_of(const SensorTimes& times) {
  std::vector<Step> all;
  for (const auto& experiment : times.experiments) {
    for (std::size_t i = 1; i < experiment.size(); ++i) {
      const Acquisition& before = experiment[i - 1];
      const Acquisition& after = experiment[i];
      if (after.index > before.index) {
        all.push_back({after.sampled_at - before.sampled_at,
                       static_cast<std::int64_t>(after.index - before.index)});
      }
    }
  }
  return all;
}

Duration median_of_one(const std::vector<Step>& steps) {
  std::vector<Duration> all;
  for (const Step& step : steps) {
    all.push_back(step.of_one());
  }
  return median(std::move(all));
}

/// Within a fifth.
bool is_near(const Step& step, Duration middle) {
  return 5 * std::chrono::abs(step.of_one() - middle) <= middle;
}

/// Three in four are near it.
bool is_steady(const std::vector<Step>& steps, Duration middle) {
  const auto near = std::count_if(steps.begin(), steps.end(),
                                  [middle](const Step& step) { return is_near(step, middle); });
  return 4 * static_cast<std::size_t>(near) >= 3 * steps.size();
}

/// Their mean, which the grid of simulated time does not round as it does each step.
Duration mean_of_near(const std::vector<Step>& steps, Duration middle) {
  Step whole{Duration::zero(), 0};
  for (const Step& step : steps) {
    if (is_near(step, middle)) {
      whole.span += step.span;
      whole.indices += step.indices;
    }
  }
  return whole.of_one();
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

Failure refuse(const SensorTimes& times, const std::string& why) {
  return {Failure::Kind::kInvalid,
          "sensor \"" + times.sensor + "\": " + why + "; use --timing on_demand"};
}

}  // namespace

TimingModel on_demand_timing(const SensorTimes& times) {
  return {std::nullopt, times.taken()};
}

Result<TimingModel> periodic_timing(const SensorTimes& times, bool may_stamp_arrival) {
  const std::vector<Step> steps = steps_of(times);
  if (steps.size() < kFewestSteps) {
    return refuse(times, "too few samples to tell its period");
  }
  const Duration middle = median_of_one(steps);
  if (middle <= Duration::zero() || !is_steady(steps, middle)) {
    return refuse(times, "its samples come too irregularly to tell a period");
  }
  TimingModel model{mean_of_near(steps, middle), delays(times)};
  const Duration shortest = may_stamp_arrival ? kShortestLiveDelay : Duration::zero();
  if (median(model.delays) < shortest ||
      *std::min_element(model.delays.begin(), model.delays.end()) < Duration::zero()) {
    return refuse(times,
                  "the device gives no instants of its own, it seems, only those of arrival");
  }
  return model;
}

}  // namespace tether::sut
