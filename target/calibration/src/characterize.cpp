#include <algorithm>
#include <utility>

#include <tether/base/result.h>
#include <tether/calibration/characterize.h>
#include <tether/tasks/task.h>

// Runs the task of Algorithm 1 for each chosen sensor and experiment, within one time limit per
// sensor, and adds the statistics of the times to the outcome.
namespace tether::calibration {
namespace {

using tasks::TaskOutcome;

std::vector<std::string> names_of(const uav::Catalogue& catalogue) {
  std::vector<std::string> names;
  for (const uav::SensorDescription& sensor : catalogue.sensors) names.push_back(sensor.name);
  return names;
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

/// The sensors that are asked for, if they are there and have what is to be measured.
Result<std::vector<const uav::SensorDescription*>> choose_sensors(
    const uav::Catalogue& catalogue, const CharacterizeOptions& options) {
  const std::vector<std::string> all = names_of(catalogue);
  std::vector<const uav::SensorDescription*> chosen;
  for (const std::string& name : options.sensors.empty() ? all : options.sensors) {
    const uav::SensorDescription* sensor = catalogue.find_sensor(name);
    if (sensor == nullptr) {
      return invalid("there is no sensor \"" + name + "\"; there are " + listed(all));
    }
    if (std::find(chosen.begin(), chosen.end(), sensor) != chosen.end()) {
      return invalid("sensor \"" + name + "\" is given twice");
    }
    if (options.timing == Timing::kPeriodic && sensor->rate_hz <= 0.0) {
      return invalid("sensor \"" + name +
                     "\" has no rate: it measures on demand. Exclude it with --sensors, or use "
                     "--timing on_demand");
    }
    chosen.push_back(sensor);
  }
  if (chosen.empty()) return invalid("there is no sensor to characterize");
  if (const Status fits = check_extent(options, chosen.size()); !fits) return fits.failure();
  return chosen;
}

class Measurement {
 public:
  Measurement(tasks::TaskContext& context, const CharacterizeOptions& options,
              const TellProgress& tell)
      : context_(context), options_(options), tell_(tell) {}

  /// Says how it ended, if not well.
  tasks::Progress measure(SensorTimes& times) {
    end_ = context_.vehicle().now() + options_.time_limit;
    if (tasks::Progress failed = turn_on(times)) return failed;
    for (int number = 1; number <= options_.experiments; ++number) {
      if (tell_) {
        tell_(times.sensor + ": experiment " + std::to_string(number) + " of " +
              std::to_string(options_.experiments));
      }
      const TaskOutcome outcome = acquire(times, options_.acquisitions);
      if (!outcome.reached()) return ended(outcome, times, number);
    }
    return std::nullopt;
  }

 private:
  /// Adds an experiment of so many acquisitions, within what is left of the sensor's time.
  TaskOutcome acquire(SensorTimes& times, int acquisitions) {
    tasks::SensorCharacterizationOptions options;
    options.acquisitions = acquisitions;
    options.time_limit = std::max(end_ - context_.vehicle().now(), Duration(1));
    tasks::SensorCharacterizationTask task(times.sensor, options);
    TaskOutcome outcome = tasks::run(task, context_);
    times.experiments.push_back(task.acquisitions());
    return outcome;
  }

  /// The listing turns sensors on before it takes the time: a sensor is on when it has given one
  /// measurement, which is not counted.
  tasks::Progress turn_on(SensorTimes& times) {
    const TaskOutcome outcome = acquire(times, 1);
    if (!outcome.reached()) return ended(outcome, times, 0);
    times.experiments.clear();
    return std::nullopt;
  }

  static TaskOutcome ended(TaskOutcome outcome, const SensorTimes& times, int number) {
    const std::string sensor = "sensor \"" + times.sensor + "\"";
    if (!outcome.failure && number == 0) {
      outcome.reason += " while turning on " + sensor;
    } else if (!outcome.failure) {
      outcome.reason += " after " + std::to_string(times.experiments.back().size()) +
                        " acquisitions of " + sensor + " in experiment " + std::to_string(number);
    }
    outcome.results.clear();
    return outcome;
  }

  tasks::TaskContext& context_;
  const CharacterizeOptions& options_;
  const TellProgress& tell_;
  ExecTime end_;  ///< of the current sensor's time
};

void add_results(const SensorTimes& times, std::map<std::string, double>& results) {
  const TimeSummary of = summarize(times.taken());
  const std::string prefix = times.sensor + "_";
  results[prefix + "n"] = static_cast<double>(of.n);
  results[prefix + "mean_s"] = of.mean_s;
  results[prefix + "min_s"] = of.min_s;
  results[prefix + "median_s"] = of.median_s;
  results[prefix + "p95_s"] = of.p95_s;
  results[prefix + "p99_s"] = of.p99_s;
  results[prefix + "max_s"] = of.max_s;
  if (of.stddev_s) results[prefix + "stddev_s"] = *of.stddev_s;
  if (const auto between_s = stddev_between_experiments_s(times)) {
    results[prefix + "stddev_between_experiments_s"] = *between_s;
  }
}

TaskOutcome measure_all(tasks::TaskContext& context, const CharacterizeOptions& options,
                        const TellProgress& tell, std::vector<SensorTimes>& all) {
  const auto chosen = choose_sensors(context.vehicle().catalogue(), options);
  if (!chosen) return TaskOutcome::failed(chosen.failure());
  Measurement measurement(context, options, tell);
  TaskOutcome whole = TaskOutcome::goal_reached();
  for (const uav::SensorDescription* sensor : *chosen) {
    all.push_back({sensor->name, sensor->kind(), {}, sensor->rate_hz});
    if (tasks::Progress end = measurement.measure(all.back())) return *std::move(end);
    add_results(all.back(), whole.results);
  }
  return whole;
}

}  // namespace

std::vector<Duration> SensorTimes::taken() const {
  std::vector<Duration> all;
  for (const auto& experiment : experiments) {
    for (const tasks::Acquisition& acquisition : experiment) {
      all.push_back(acquisition.had_at - acquisition.asked_at);
    }
  }
  return all;
}

Status check_extent(const CharacterizeOptions& options, std::size_t sensors) {
  const std::int64_t all =
      std::int64_t{options.acquisitions} * options.experiments * static_cast<std::int64_t>(sensors);
  if (all <= kMostAcquisitions) return ok_status();
  return invalid("--acquisitions times --experiments of " + std::to_string(sensors) +
                 (sensors == 1 ? " sensor is " : " sensors is ") + std::to_string(all) +
                 "; at most " + std::to_string(kMostAcquisitions) + " fit a profile");
}

Characterization characterize(client::Vehicle& vehicle, const CharacterizeOptions& options,
                              const TellProgress& tell) {
  const ExecTime start = vehicle.now();
  tasks::TaskContext context(vehicle);
  Characterization result;
  result.outcome = measure_all(context, options, tell, result.sensors);
  result.outcome.task = "characterize";
  result.outcome.results["duration_s"] = to_seconds(vehicle.now() - start);
  return result;
}

}  // namespace tether::calibration
