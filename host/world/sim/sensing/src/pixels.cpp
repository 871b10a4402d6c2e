#include "pixels.h"

#include "sensor_noise.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <tether/base/error.h>
#include <tether/sim_raster/renderer.h>

namespace tether::sim {
namespace {

constexpr double kNearestSeen_m = 1e-3;
constexpr float kBeyond = std::numeric_limits<float>::infinity();

}  // namespace

double near_m(const CameraModel& camera) {
  return uav::has_depth(camera.kind) ? std::min(camera.near_m, kNearestSeen_m) : camera.near_m;
}

void finish_depths(const CameraModel& camera, const MeasurementKey& key, std::span<float> depth_m) {
  if (camera.kind == uav::CameraKind::kDepth) {
    const std::uint64_t stream = random_stream(key.uav, key.sensor, "depths");
    add_depth_noise(camera.pixel_noise, {key.seed, stream, key.index, key.at}, depth_m);
  }
  for (float& depth : depth_m) {
    if (depth < camera.depth_min_m) depth = -kBeyond;
    if (depth > camera.depth_max_m) depth = kBeyond;
  }
}

std::vector<std::uint16_t> labels_of(std::span<const std::uint32_t> models, const Sensor& sensor) {
  constexpr std::uint32_t kMost = std::numeric_limits<std::uint16_t>::max();
  if (std::ranges::any_of(models, [](std::uint32_t model) { return model > kMost; })) {
    throw Error(ErrorCode::kBadFile, sensor.declared_at,
                "sensor '" + sensor.name +
                    "' sees a model beyond the 65535th of the world, which has no label")
        .about(sensor.name);
  }
  return {models.begin(), models.end()};
}

std::vector<uav::SeenAnchor> find_anchors(const World& world, std::span<const std::uint32_t> models,
                                          int width_px) {
  std::vector<uav::SeenAnchor> seen(world.anchors.size());
  for (const auto& [number, box] : raster::visible_boxes(models, width_px)) {
    const std::string& model = model_name(world, number);
    for (std::size_t i = 0; i < seen.size(); ++i) {
      const std::string& anchor = world.anchors[i].anchor.name;
      if (model != anchor && !model.starts_with(anchor + "::")) continue;
      uav::SeenAnchor& all = seen[i];
      if (all.pixels == 0) all = {anchor, box.left, box.top, box.right, box.bottom, 0};
      all.left_px = std::min(all.left_px, box.left);
      all.top_px = std::min(all.top_px, box.top);
      all.right_px = std::max(all.right_px, box.right);
      all.bottom_px = std::max(all.bottom_px, box.bottom);
      all.pixels += static_cast<std::int64_t>(box.pixels);
    }
  }
  std::erase_if(seen, [](const uav::SeenAnchor& anchor) { return anchor.pixels == 0; });
  return seen;
}

}  // namespace tether::sim
