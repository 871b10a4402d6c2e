#include "sensors/sensor_key.h"

#include <algorithm>
#include <cstdint>

#include <fmt/format.h>

#include <tether/base/units.h>

namespace tether::scenario {
namespace {

using sim::CameraModel;

struct ImageSize {
  int width_px = 0;
  int height_px = 0;
};

ImageSize size(const toml::Table& camera, std::string_view key) {
  constexpr std::int64_t kLongestEdge_px = 4096;
  const std::vector<std::int64_t> size = camera.integers(key, 1);
  if (size.size() != 2)
    camera.fail(key, fmt::format("must be [width, height], but has {} elements", size.size()));
  for (const std::int64_t edge_px : size) {
    if (edge_px <= kLongestEdge_px) continue;
    camera.fail(key, fmt::format("must be at most {} each, but has {}", kLongestEdge_px, edge_px));
  }
  return {static_cast<int>(size[0]), static_cast<int>(size[1])};
}

/// A lens with nothing but these coefficients.
uav::CameraModel distortion(const toml::Table& camera, std::string_view key) {
  constexpr toml::Range kCoefficient{.min = -100.0, .max = 100.0};
  const toml::Table table = camera.table(key, {"k1", "k2", "k3", "p1", "p2"});
  uav::CameraModel lens;
  lens.k1 = table.number_or("k1", kCoefficient, 0.0);
  lens.k2 = table.number_or("k2", kCoefficient, 0.0);
  lens.k3 = table.number_or("k3", kCoefficient, 0.0);
  lens.p1 = table.number_or("p1", kCoefficient, 0.0);
  lens.p2 = table.number_or("p2", kCoefficient, 0.0);
  return lens;
}

void distort(CameraModel& camera, const uav::CameraModel& by) {
  uav::CameraModel& lens = camera.intrinsics;
  lens.k1 = by.k1;
  lens.k2 = by.k2;
  lens.k3 = by.k3;
  lens.p1 = by.p1;
  lens.p2 = by.p2;
}

double undistorted_fov_rad(uav::CameraModel lens) {
  lens.k1 = lens.k2 = lens.k3 = lens.p1 = lens.p2 = 0.0;
  return lens.horizontal_fov_rad();
}

/// An ideal lens; the distortion stays.
void remake_lens(CameraModel& camera, ImageSize size, double horizontal_fov_rad) {
  uav::CameraModel& lens = camera.intrinsics;
  const uav::CameraModel before = lens;
  lens = uav::CameraModel::from_horizontal_fov(size.width_px, size.height_px, horizontal_fov_rad);
  distort(camera, before);
}

/// A row is exposed once per image, so its exposure cannot be longer than the period; nor can the
/// readout, since the rows of the next image follow.
void check_shutter(const CameraModel& camera, const Finished& sensor) {
  constexpr double kLongest_s = 1.0;
  const auto refuse = [&](const std::string& problem) {
    sensor.refuse({"exposure_ms", "readout_ms", "timing"},
                  fmt::format("has exposure_ms = {:.6g} and readout_ms = {:.6g}. {}.",
                              camera.exposure_s * 1e3, camera.readout_s * 1e3, problem));
  };
  if (camera.exposure_s + camera.readout_s > kLongest_s)
    refuse(fmt::format("Their sum must be at most {:.6g}", kLongest_s * 1e3));
  const auto* periodic = std::get_if<uav::PeriodicTiming>(&sensor.timing);
  if (periodic == nullptr) return;
  const double period_s = to_seconds(periodic->period);
  if (camera.exposure_s > period_s || camera.readout_s > period_s)
    refuse(fmt::format("Each must be at most the period, {:.6g}", period_s * 1e3));
}

}  // namespace

// The size comes before the field of view: it keeps the one that was.
std::vector<SensorKey> keys_of(std::type_identity<CameraModel>) {
  constexpr toml::Range kFieldOfView_deg{.min = 0.3, .max = 179.9};
  constexpr toml::Range kTime_ms{.min = 0.0, .max = 1000.0};
  return {
      row<CameraModel>("size_px", size,
                       [](CameraModel& camera, ImageSize size) {
                         remake_lens(camera, size, undistorted_fov_rad(camera.intrinsics));
                       }),
      row<CameraModel>("horizontal_fov_deg", number(kFieldOfView_deg, rad_from_deg(1.0)),
                       [](CameraModel& camera, double fov_rad) {
                         const uav::CameraModel& lens = camera.intrinsics;
                         remake_lens(camera, {lens.width_px, lens.height_px}, fov_rad);
                       }),
      row<CameraModel>("distortion", distortion, distort),
      row<CameraModel>("noise", noise, &CameraModel::pixel_noise),
      row<CameraModel>("exposure_ms", number(kTime_ms, 1e-3), &CameraModel::exposure_s),
      row<CameraModel>("readout_ms", number(kTime_ms, 1e-3), &CameraModel::readout_s),
      row<CameraModel>("antialias", boolean, &CameraModel::antialias),
      row<CameraModel>("min_m", number(kDistance_m), &CameraModel::depth_min_m),
      row<CameraModel>("max_m", number(kFarthest_m), &CameraModel::depth_max_m),
  };
}

// A camera sees as far as it measures.
void complete(CameraModel& camera, const Finished& sensor) {
  for (const std::string_view key : {"min_m", "max_m"}) {
    if (sensor.laid.has(key) && !uav::has_depth(camera.kind))
      sensor.unfit(key, "it measures no depths");
  }
  if (sensor.laid.has("noise") && camera.kind == uav::CameraKind::kSegmentation &&
      camera.pixel_noise != sim::Noise{}) {
    sensor.unfit("noise", "labels have no noise");
  }
  if (sensor.laid.has("antialias") && camera.antialias && !uav::has_color(camera.kind))
    sensor.unfit("antialias", "it measures no colours");
  if (sensor.laid.has("antialias")) camera.antialias_at = sensor.laid.at({"antialias"});
  camera.far_m = std::max(camera.far_m, camera.depth_max_m);
  if (uav::has_depth(camera.kind)) sensor.check_limits(camera.depth_min_m, camera.depth_max_m);
  check_shutter(camera, sensor);
}

}  // namespace tether::scenario
