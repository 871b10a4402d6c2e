#include <algorithm>
#include <utility>

#include <tether/stats/sample_statistics.h>
#include <tether/tasks/paper_tasks.h>
#include <tether/tasks/task.h>

namespace tether::tasks {
namespace {

/// Where a sample stands among those of its sensor.
struct Place {
  SimTime sampled_at;
  std::uint64_t index = 0;
};

Result<Place> acquire(client::Vehicle& vehicle, const std::string& sensor, uav::SensorKind kind) {
  const auto sample = vehicle.read_any(sensor, kind, client::Read::kNext);
  if (!sample) return sample.failure();
  return std::visit([](const auto& one) { return Place{one.sampled_at, one.index}; }, *sample);
}

/// What each took, the shortest first.
std::vector<double> sorted_times_s(const std::vector<Acquisition>& acquisitions) {
  std::vector<double> taken_s;
  for (const Acquisition& acquisition : acquisitions) {
    taken_s.push_back(to_seconds(acquisition.had_at - acquisition.asked_at));
  }
  std::sort(taken_s.begin(), taken_s.end());
  return taken_s;
}

}  // namespace

SensorCharacterizationTask::SensorCharacterizationTask(std::string sensor,
                                                       const SensorCharacterizationOptions& options)
    : sensor_(std::move(sensor)),
      options_(options),
      limit_(options.time_limit, options.acquisitions) {}

Progress SensorCharacterizationTask::initialise(TaskContext& context) {
  limit_.start(context.vehicle().now());
  acquisitions_.clear();
  const auto sensor = context.sensor(sensor_);
  if (!sensor) return TaskOutcome::failed(sensor.failure());
  kind_ = (*sensor)->kind();
  return std::nullopt;
}

Progress SensorCharacterizationTask::step(TaskContext& context) {
  const ExecTime before = context.vehicle().now();
  if (Progress end = limit_.next_round(before)) return end;
  const Result<Place> place = acquire(context.vehicle(), sensor_, kind_);
  if (!place) return TaskOutcome::failed(place.failure());
  acquisitions_.push_back({before, context.vehicle().now(), place->sampled_at, place->index});
  const bool is_last = acquisitions_.size() >= static_cast<std::size_t>(options_.acquisitions);
  return is_last ? Progress(TaskOutcome::goal_reached()) : std::nullopt;
}

void SensorCharacterizationTask::finalise(TaskContext& context, TaskOutcome& outcome) {
  outcome.results["duration_s"] = to_seconds(limit_.elapsed(context.vehicle().now()));
  outcome.results["acquisitions"] = static_cast<double>(acquisitions_.size());
  if (acquisitions_.empty()) return;
  const std::vector<double> taken_s = sorted_times_s(acquisitions_);
  outcome.results["mean_s"] = stats::mean(taken_s);
  outcome.results["min_s"] = taken_s.front();
  outcome.results["median_s"] = stats::quantile(taken_s, 0.5);
  outcome.results["max_s"] = taken_s.back();
  if (const auto stddev_s = stats::sample_stddev(taken_s)) outcome.results["stddev_s"] = *stddev_s;
}

}  // namespace tether::tasks
