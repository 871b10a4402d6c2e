#include "sensors/sampler.h"

#include <algorithm>
#include <utility>

#include <tether/base/error.h>

namespace tether::coordinator {

// A read without a measurement marks none as read.
std::optional<Measurement> Sampler::plan(std::uint64_t call, const link::ReadSensor& read,
                                         SimTime t) {
  SensorSchedule& schedule = sensors_[read.sensor].schedule;
  schedule.set_queue(read.queue, t);
  const auto measurement = read.only_if_available ? schedule.choose_available(t, read.latest)
                                                  : schedule.choose(t, read.latest);
  if (!measurement) return std::nullopt;
  if (!read.latest) sensors_[read.sensor].unqueued += schedule.unqueued(*measurement, read.queue);
  schedule.mark_read(*measurement);
  sensors_[read.sensor].forecast.requested(t, read.latest, measurement->index);
  sensors_[read.sensor].forecasted.reset();
  const bool on_demand = !schedule.sampling_instant(measurement->index);
  reads_.push_back(
      {.call = call, .sensor = read.sensor, .measurement = *measurement, .on_demand = on_demand});
  return measurement;
}

std::vector<std::pair<std::string, std::uint64_t>> Sampler::unqueued() const {
  std::vector<std::pair<std::string, std::uint64_t>> unqueued;
  for (const Sensor& sensor : sensors_)
    if (sensor.unqueued > 0) unqueued.emplace_back(sensor.name, sensor.unqueued);
  return unqueued;
}

std::optional<std::uint64_t> Sampler::skip(const link::ReadSensor& read, SimTime t) {
  SensorSchedule& schedule = sensors_[read.sensor].schedule;
  schedule.set_queue(read.queue, t);
  const auto newest = schedule.choose_available(t, true);
  if (!newest || schedule.is_read(newest->index)) return std::nullopt;
  schedule.mark_read(*newest);
  return newest->index;
}

SimTime Sampler::next_due() const {
  SimTime due = SimTime::max();
  for (const Read& read : reads_)
    if (read.on_demand && !read.state)
      due = std::min(due, grid_.floor(read.measurement.sampled_at));
  if (closed_) return due;
  for (const Sensor& sensor : sensors_)
    if (const auto instant = sensor.schedule.sampling_instant(sensor.next_capture))
      due = std::min(due, grid_.floor(*instant));
  return due;
}

void Sampler::sample(SimTime st, SimTime earliest, const Capture& capture) {
  for (Read& read : reads_) {
    if (!read.on_demand || read.state) continue;
    if (grid_.floor(read.measurement.sampled_at) > st) continue;
    read.state = capture();
  }
  if (closed_) return;
  for (std::size_t i = 0; i < sensors_.size(); ++i) sample_periodic(i, st, earliest, capture);
}

void Sampler::sample_periodic(std::size_t sensor, SimTime st, SimTime earliest,
                              const Capture& capture) {
  Sensor& state = sensors_[sensor];
  auto instant = state.schedule.sampling_instant(state.next_capture);
  while (instant && grid_.floor(*instant) <= st) {
    state.captures.add(state.next_capture, capture());
    instant = state.schedule.sampling_instant(++state.next_capture);
    state.captures.drop_before(first_needed(sensor, earliest));
  }
}

// First index that a planned or a later read needs.
std::uint64_t Sampler::first_needed(std::size_t sensor, SimTime earliest) const {
  std::uint64_t first = sensors_[sensor].schedule.first_readable(earliest);
  for (const Read& read : reads_)
    if (read.sensor == sensor) first = std::min(first, read.measurement.content());
  return first;
}

const Sampler::Read* Sampler::find(std::uint64_t call) const {
  const auto read =
      std::find_if(reads_.begin(), reads_.end(), [call](const Read& r) { return r.call == call; });
  return read == reads_.end() ? nullptr : &*read;
}

const sim::Snapshot* Sampler::find_state(const Read& read) const {
  if (!read.on_demand) return sensors_[read.sensor].captures.find(read.measurement.content());
  return read.state.get();
}

const sim::Snapshot& Sampler::state_of(const Read& read) const {
  if (const sim::Snapshot* state = find_state(read)) return *state;
  throw Error(ErrorCode::kInternal, "the state of a measurement was dropped before it was read");
}

void Sampler::answered(std::uint64_t call, SimTime t) {
  const auto read =
      std::find_if(reads_.begin(), reads_.end(), [call](const Read& r) { return r.call == call; });
  if (read == reads_.end()) return;
  Sensor& sensor = sensors_[read->sensor];
  if (sensor.is_drawn && !read->on_demand) {
    sensor.forecast.replied(t);
    if (const auto index = sensor.forecast.next(sensor.schedule))
      sensor.forecasted = sensor.schedule.content_of(*index);
  }
  reads_.erase(read);
}

void Sampler::announce(const Announce& announce) {
  for (Read& read : reads_) {
    if (read.announced || !sensors_[read.sensor].is_drawn) continue;
    const sim::Snapshot* state = find_state(read);
    if (!state) continue;
    announce(*state, read.sensor, read.measurement.content());
    read.announced = true;
  }
  for (std::size_t i = 0; i < sensors_.size(); ++i) {
    Sensor& sensor = sensors_[i];
    if (!sensor.forecasted) continue;
    const sim::Snapshot* state = sensor.captures.find(*sensor.forecasted);
    if (!state) continue;
    announce(*state, i, *sensor.forecasted);
    sensor.forecasted.reset();
  }
}

void Sampler::close() {
  closed_ = true;
  for (Sensor& sensor : sensors_) sensor.forecasted.reset();
  reads_.clear();
}

}  // namespace tether::coordinator
