#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <tether/calibration/characterize.h>

// Derives a sensor's period and delays from its acquisitions. Steps between timestamps give the
// period; a regression of the delays over time shows whether timestamps and clock run at the same
// speed; the last checks reject timestamps that are in the future or only times of arrival.
namespace tether::calibration {
namespace {

using tasks::Acquisition;

constexpr std::size_t kFewestSteps = 3;
constexpr Duration kShortestLiveDelay = std::chrono::milliseconds(5);
/// What the profile's reader takes.
constexpr Duration kShortestPeriod = std::chrono::microseconds(10);
constexpr Duration kLongestPeriod = std::chrono::seconds(1000);
constexpr double kMostDrift = 0.02;  ///< of the measured span, besides a period

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
  for (const Step& step : steps) all.push_back(step.of_one());
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

/// How a sensor's delays change while they are measured, by least squares.
struct Drift {
  double span_s = 0.0;         ///< on this program's clock
  double of_delays_s = 0.0;    ///< over that span
  double from_jitter_s = 0.0;  ///< what jitter alone would hardly exceed
};

/// When each sample was had, and its delay, both from the first one's [s].
std::vector<std::pair<double, double>> delays_by_arrival(const SensorTimes& times) {
  std::vector<std::pair<double, double>> all;
  const Acquisition& origin = times.experiments.front().front();
  const Duration first = origin.had_at - same_instant(origin.sampled_at);
  for (const auto& experiment : times.experiments) {
    for (std::size_t i = 1; i < experiment.size(); ++i) {
      const Acquisition& acquisition = experiment[i];
      const Duration delay = acquisition.had_at - same_instant(acquisition.sampled_at);
      all.emplace_back(to_seconds(acquisition.had_at - origin.had_at), to_seconds(delay - first));
    }
  }
  return all;
}

/// Four standard errors; of few delays more, because their spread is not well known.
double unlikely_errors(double degrees_of_freedom) {
  return 4.0 * (1.0 + 8.0 / degrees_of_freedom);
}

/// @pre three delays or more
Drift drift_of(const SensorTimes& times) {
  const auto points = delays_by_arrival(times);
  const auto n = static_cast<double>(points.size());
  double t = 0.0, d = 0.0;
  for (const auto& [at, delay] : points) {
    t += at / n;
    d += delay / n;
  }
  double tt = 0.0, td = 0.0, dd = 0.0;
  for (const auto& [at, delay] : points) {
    tt += (at - t) * (at - t);
    td += (at - t) * (delay - d);
    dd += (delay - d) * (delay - d);
  }
  if (tt <= 0.0) return {};
  const double slope = td / tt;
  const double span_s = points.back().first - points.front().first;
  const double residuals = std::max(dd - slope * td, 0.0);
  const double standard_error = std::sqrt(residuals / (n - 2.0) / tt);
  return {span_s, slope * span_s, unlikely_errors(n - 2.0) * standard_error * span_s};
}

bool runs_at_our_pace(const SensorTimes& times, Duration period) {
  const Drift drift = drift_of(times);
  const double size_s = std::abs(drift.of_delays_s);
  return size_s <= kMostDrift * drift.span_s + to_seconds(period) || size_s <= drift.from_jitter_s;
}

Failure refuse(const SensorTimes& times, const std::string& why) {
  return {Failure::Kind::kInvalid, "sensor \"" + times.sensor + "\": " + why};
}

}  // namespace

TimingModel on_demand_timing(const SensorTimes& times) {
  return {std::nullopt, times.taken()};
}

Result<TimingModel> periodic_timing(const SensorTimes& times, bool may_stamp_arrival) {
  const std::vector<Step> steps = steps_of(times);
  if (steps.size() < kFewestSteps) return refuse(times, "too few samples to determine its period");
  const Duration middle = median_of_one(steps);
  if (middle <= Duration::zero() || !is_steady(steps, middle)) {
    return refuse(times, "its samples are too irregular to determine a period");
  }
  TimingModel model{mean_of_near(steps, middle), delays(times)};
  if (*model.period < kShortestPeriod || *model.period > kLongestPeriod) {
    return refuse(times, "its period must be from 0.01 ms to 1000 s for a profile");
  }
  if (!runs_at_our_pace(times, *model.period)) {
    return refuse(times,
                  "its timestamps and this program's clock run at different speeds, as in a run "
                  "without synchronisation");
  }
  if (*std::min_element(model.delays.begin(), model.delays.end()) < Duration::zero()) {
    return refuse(times,
                  "some timestamps are in the future, so they are not from this program's clock");
  }
  if (may_stamp_arrival && median(model.delays) < kShortestLiveDelay) {
    return refuse(times, "the device seems to give the time of arrival instead of a timestamp");
  }
  return model;
}

Result<ChosenTiming> choose_timing(const SensorTimes& times, Timing timing,
                                   bool may_stamp_arrival) {
  const bool is_periodic = timing == Timing::kPeriodic;
  if (!is_periodic && (timing == Timing::kOnDemand || times.rate_hz <= 0.0)) {
    return ChosenTiming{on_demand_timing(times), ""};
  }
  Result<TimingModel> model = periodic_timing(times, may_stamp_arrival);
  if (model) return ChosenTiming{std::move(model).value(), ""};
  const std::string& why = model.failure().message;
  if (is_periodic) return Failure{model.failure().kind, why + "; use --timing on_demand"};
  return ChosenTiming{on_demand_timing(times), why + "; its model is on_demand"};
}

}  // namespace tether::calibration
