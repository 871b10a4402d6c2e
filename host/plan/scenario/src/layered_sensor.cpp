#include "layered_sensor.h"

#include "tables/read_sensor_profile.h"

#include <cmath>

#include <fmt/format.h>

// Each layer replaces what it sets. Values that exclude each other are found at the end, because a
// later layer may still change one of them.
namespace tether::scenario {
namespace {

uav::SensorTiming timing_of_sdf(const sim::Sensor& sensor) {
  if (sensor.update_rate_hz <= 0.0) return uav::OnDemandTiming{};
  uav::PeriodicTiming timing;
  timing.period = duration_from_seconds(1.0 / sensor.update_rate_hz);
  return timing;
}

/// The rate that a person would write for this period: a multiple of 0.001 Hz if one gives it.
double rate_hz(Duration period) {
  const double exact = 1.0 / to_seconds(period);
  const double written = std::round(exact * 1e3) / 1e3;
  const bool is_same = written > 0.0 && duration_from_seconds(1.0 / written) == period;
  return is_same ? written : exact;
}

/// What needs a period.
void check_driver(const uav::DriverModel& driver, const Finished& sensor) {
  const auto* periodic = std::get_if<uav::PeriodicTiming>(&sensor.timing);
  const bool skips = driver.lost_probability > 0.0 || driver.repeated_probability > 0.0;
  if (skips && !periodic)
    sensor.refuse({"lost_probability", "repeated_probability"},
                  "measures on demand, so no sample is lost or repeated. Set "
                  "timing = \"periodic\", or remove the probability.");
  if (periodic && 2 * driver.stamp_jitter > periodic->period)
    sensor.refuse(
        {"stamp_jitter_ms"},
        fmt::format("has stamp_jitter_ms = {:.6g}, but measures every {:.6g} ms. The "
                    "jitter must be at most half of that.",
                    1e3 * to_seconds(driver.stamp_jitter), 1e3 * to_seconds(periodic->period)));
}

}  // namespace

LayeredSensor::LayeredSensor(sim::Sensor& sensor)
    : sensor_(&sensor), timing_(timing_of_sdf(sensor)), rate_at_(sensor.declared_at) {}

void LayeredSensor::lay(const SensorProfile& layer) {
  require_kind(layer, sensor_->name, sensor_->kind());
  laid_.add(layer);
  lay_timing(layer);
  for (const SensorSetting& setting : layer.settings)
    if (!setting.kind || setting.kind == sensor_->kind()) setting.set(*sensor_);
}

void LayeredSensor::lay_timing(const SensorProfile& layer) {
  is_timed_ |= layer.timing.has_value();
  if (layer.timing) {
    timing_ = *layer.timing;
    rate_at_ = layer.at(layer.lines.contains("rate_hz") ? "rate_hz" : "timing");
  } else if (layer.delay) {
    std::visit([&](auto& timing) { timing.delay = *layer.delay; }, timing_);
  }
}

uav::SensorTiming LayeredSensor::finish() {
  const Finished finished{sensor_->name, timing_, laid_};
  check_driver(sensor_->driver, finished);
  std::visit([&](auto& model) { complete(model, finished); }, sensor_->model);
  if (is_timed_) {
    const auto* periodic = std::get_if<uav::PeriodicTiming>(&timing_);
    sensor_->update_rate_hz = periodic ? rate_hz(periodic->period) : 0.0;
  }
  return timing_;
}

}  // namespace tether::scenario
