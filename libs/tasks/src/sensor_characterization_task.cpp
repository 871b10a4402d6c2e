#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <tether/tasks/sensor_characterization_task.h>
#include <tether/tasks/task_context.h>

namespace tether::tasks {
namespace {

template <class Sample>
Status status_of(const Result<Sample>& sample) {
  return sample ? ok_status() : Status(sample.failure());
}

Status acquire(client::Vehicle& vehicle, const std::string& sensor, uav::SensorKind kind) {
  switch (kind) {
    case uav::SensorKind::kCamera:
      return status_of(vehicle.read_camera(sensor));
    case uav::SensorKind::kImu:
      return status_of(vehicle.read_imu(sensor));
    case uav::SensorKind::kRange:
      break;
  }
  return status_of(vehicle.read_range(sensor));
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// @pre two values or more
double sample_stddev(const std::vector<double>& values) {
  const double middle = mean(values);
  double squares = 0.0;
  for (const double value : values) {
    squares += (value - middle) * (value - middle);
  }
  return std::sqrt(squares / static_cast<double>(values.size() - 1));
}

/// @pre sorted, not empty
double median(const std::vector<double>& sorted) {
  const std::size_t half = sorted.size() / 2;
  return sorted.size() % 2 == 1 ? sorted[half] : 0.5 * (sorted[half - 1] + sorted[half]);
}

}  // namespace

SensorCharacterizationTask::SensorCharacterizationTask(std::string sensor,
                                                       const SensorCharacterizationOptions& options)
    : sensor_(std::move(sensor)),
      options_(options),
      limit_(options.time_limit, options.acquisitions) {}

Progress SensorCharacterizationTask::initialise(TaskContext& context) {
  limit_.start(context.vehicle().now());
  taken_s_.clear();
  const auto sensor = context.sensor(sensor_);
  if (!sensor) {
    return TaskOutcome::failed(sensor.failure());
  }
  kind_ = (*sensor)->kind();
  return std::nullopt;
}

Progress SensorCharacterizationTask::step(TaskContext& context) {
  const ExecTime before = context.vehicle().now();
  if (Progress end = limit_.next_round(before)) {
    return end;
  }
  if (const Status acquired = acquire(context.vehicle(), sensor_, kind_); !acquired) {
    return TaskOutcome::failed(acquired.failure());
  }
  taken_s_.push_back(to_seconds(context.vehicle().now() - before));
  const bool is_last = taken_s_.size() >= static_cast<std::size_t>(options_.acquisitions);
  return is_last ? Progress(TaskOutcome::goal_reached()) : std::nullopt;
}

void SensorCharacterizationTask::finalise(TaskContext& context, TaskOutcome& outcome) {
  outcome.results["duration_s"] = to_seconds(limit_.elapsed(context.vehicle().now()));
  outcome.results["acquisitions"] = static_cast<double>(taken_s_.size());
  if (taken_s_.empty()) {
    return;
  }
  std::sort(taken_s_.begin(), taken_s_.end());
  outcome.results["mean_s"] = mean(taken_s_);
  outcome.results["min_s"] = taken_s_.front();
  outcome.results["median_s"] = median(taken_s_);
  outcome.results["max_s"] = taken_s_.back();
  if (taken_s_.size() > 1) {
    outcome.results["stddev_s"] = sample_stddev(taken_s_);
  }
}

}  // namespace tether::tasks
