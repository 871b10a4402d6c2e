#include "layered_sensor.h"

#include "tables/read_sensor_profile.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include <fmt/format.h>

#include <tether/sim/range_rays.h>

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

template <class T>
void replace(T& value, const std::optional<T>& by) {
  if (by) value = *by;
}

/// The layer's key that comes first in `keys`, if it has one of them.
void note(FileLocation& at, const SensorProfile& layer,
          std::initializer_list<std::string_view> keys) {
  for (const std::string_view key : keys) {
    if (!layer.lines.contains(key)) continue;
    at = layer.at(key);
    return;
  }
}

/// Refuses the keys that do not fit the sensor's type in SDF.
void refuse(const SensorProfile& layer, std::initializer_list<std::string_view> keys,
            const sim::Sensor& sensor, std::string_view reason) {
  for (const std::string_view key : keys) {
    if (!layer.lines.contains(key)) continue;
    throw Error(
        ErrorCode::kBadFile, layer.at(key),
        fmt::format("'{}' does not fit the camera '{}', because {}", key, sensor.name, reason))
        .about(std::string(key));
  }
}

/// The rate that a person would write for this period: a multiple of 0.001 Hz if one gives it.
double rate_hz(Duration period) {
  const double exact = 1.0 / to_seconds(period);
  const double written = std::round(exact * 1e3) / 1e3;
  const bool is_same = written > 0.0 && duration_from_seconds(1.0 / written) == period;
  return is_same ? written : exact;
}

double undistorted_fov_rad(uav::CameraModel model) {
  model.k1 = model.k2 = model.k3 = model.p1 = model.p2 = 0.0;
  return model.horizontal_fov_rad();
}

/// An ideal lens of the given field of view and size; the distortion stays.
void remake_lens(uav::CameraModel& model, const SensorProfile& layer) {
  if (!layer.size && !layer.horizontal_fov_rad) return;
  const ImageSize size = layer.size.value_or(ImageSize{model.width_px, model.height_px});
  const uav::CameraModel ideal = uav::CameraModel::from_horizontal_fov(
      size.width_px, size.height_px, layer.horizontal_fov_rad.value_or(undistorted_fov_rad(model)));
  model.width_px = ideal.width_px;
  model.height_px = ideal.height_px;
  model.fx_px = ideal.fx_px;
  model.fy_px = ideal.fy_px;
  model.cx_px = ideal.cx_px;
  model.cy_px = ideal.cy_px;
}

void distort(uav::CameraModel& model, const Distortion& by) {
  model.k1 = by.k1;
  model.k2 = by.k2;
  model.k3 = by.k3;
  model.p1 = by.p1;
  model.p2 = by.p2;
}

}  // namespace

LayeredSensor::LayeredSensor(sim::Sensor& sensor)
    : sensor_(&sensor), timing_(timing_of_sdf(sensor)), rate_at_(sensor.declared_at) {}

void LayeredSensor::lay(const SensorProfile& layer) {
  require_kind(layer, sensor_->name, sensor_->kind());
  lay_timing(layer);
  replace(sensor_->X_BS.p, layer.p_BS);
  replace(sensor_->X_BS.q, layer.q_BS);
  std::visit([&](auto& model) { lay_model(layer, model); }, sensor_->model);
}

void LayeredSensor::lay_timing(const SensorProfile& layer) {
  is_timed_ |= layer.timing.has_value();
  if (layer.timing) {
    timing_ = *layer.timing;
    note(rate_at_, layer, {"rate_hz", "timing"});
  } else if (layer.delay) {
    std::visit([&](auto& timing) { timing.delay = *layer.delay; }, timing_);
  }
}

void LayeredSensor::lay_model(const SensorProfile& layer, sim::CameraModel& camera) {
  if (!uav::has_depth(camera.kind))
    refuse(layer, {"min_m", "max_m"}, *sensor_, "it measures no depths");
  if (camera.kind == uav::CameraKind::kSegmentation && layer.pixel_noise &&
      *layer.pixel_noise != sim::Noise{}) {
    refuse(layer, {"noise"}, *sensor_, "labels have no noise");
  }
  if (!uav::has_color(camera.kind) && layer.antialias.value_or(false)) {
    refuse(layer, {"antialias"}, *sensor_, "it measures no colours");
  }
  remake_lens(camera.intrinsics, layer);
  if (layer.distortion) distort(camera.intrinsics, *layer.distortion);
  replace(camera.pixel_noise, layer.pixel_noise);
  replace(camera.exposure_s, layer.exposure_s);
  replace(camera.readout_s, layer.readout_s);
  note(shutter_at_, layer, {"exposure_ms", "readout_ms", "timing"});
  replace(camera.antialias, layer.antialias);
  note(camera.antialias_at, layer, {"antialias"});
  replace(camera.depth_min_m, layer.min_m);
  replace(camera.depth_max_m, layer.max_m);
  note(limits_at_, layer, {"min_m", "max_m"});
}

void LayeredSensor::lay_model(const SensorProfile& layer, sim::ImuModel& imu) {
  if (layer.angular_velocity_noise) imu.angular_velocity.fill(*layer.angular_velocity_noise);
  if (layer.linear_acceleration_noise) {
    imu.linear_acceleration.fill(*layer.linear_acceleration_noise);
  }
}

void LayeredSensor::lay_model(const SensorProfile& layer, sim::RangeModel& range) {
  replace(range.min_m, layer.min_m);
  replace(range.max_m, layer.max_m);
  replace(range.resolution_m, layer.resolution_m);
  replace(range.dropout_probability, layer.dropout_probability);
  replace(range.noise, layer.range_noise);
  if (layer.field_of_view_rad) range.rays_S = sim::cone_of_rays(*layer.field_of_view_rad);
  note(limits_at_, layer, {"min_m", "max_m"});
}

uav::SensorTiming LayeredSensor::finish() {
  // A camera sees as far as it measures.
  if (auto* camera = std::get_if<sim::CameraModel>(&sensor_->model)) {
    camera->far_m = std::max(camera->far_m, camera->depth_max_m);
  }
  std::visit([&](const auto& model) { check(model); }, sensor_->model);
  if (is_timed_) {
    const auto* periodic = std::get_if<uav::PeriodicTiming>(&timing_);
    sensor_->update_rate_hz = periodic ? rate_hz(periodic->period) : 0.0;
  }
  return timing_;
}

// A row is exposed once per image, so its exposure cannot be longer than the period; nor can the
// readout, since the rows of the next image follow.
void LayeredSensor::check(const sim::CameraModel& camera) const {
  constexpr double kLongest_s = 1.0;
  if (uav::has_depth(camera.kind)) check_limits(camera.depth_min_m, camera.depth_max_m);
  const auto refuse = [&](const std::string& problem) {
    throw Error(
        ErrorCode::kBadFile, shutter_at_,
        fmt::format("the camera '{}' has exposure_ms = {:.6g} and readout_ms = {:.6g}. {}.",
                    sensor_->name, camera.exposure_s * 1e3, camera.readout_s * 1e3, problem))
        .about(sensor_->name);
  };
  if (camera.exposure_s + camera.readout_s > kLongest_s) {
    refuse(fmt::format("Their sum must be at most {:.6g}", kLongest_s * 1e3));
  }
  const auto* periodic = std::get_if<uav::PeriodicTiming>(&timing_);
  if (periodic == nullptr) return;
  const double period_s = to_seconds(periodic->period);
  if (camera.exposure_s > period_s || camera.readout_s > period_s) {
    refuse(fmt::format("Each must be at most the period, {:.6g}", period_s * 1e3));
  }
}

void LayeredSensor::check_limits(double min_m, double max_m) const {
  if (min_m < max_m) return;
  throw Error(
      ErrorCode::kBadFile, limits_at_,
      fmt::format("the sensor '{}' has min_m = {:.6g} and max_m = {:.6g}. min_m must be less than "
                  "max_m.",
                  sensor_->name, min_m, max_m))
      .about(sensor_->name);
}

}  // namespace tether::scenario
