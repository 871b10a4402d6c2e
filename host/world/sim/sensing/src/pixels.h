#pragma once

#include "sensors/measurement.h"

#include <cstdint>
#include <span>
#include <vector>

#include <tether/sim/world.h>
#include <tether/uav/samples.h>

/// What cameras measure besides colours, from what a renderer draws.
namespace tether::sim {

/// From where on a camera sees. One that measures depths sees what is too near for it, too, and not
/// what is behind that.
double near_m(const CameraModel& camera);

/// Adds the noise of a depth camera to true depths, then replaces those beyond the limits by −inf
/// and +inf (REP-117). NaN stays.
void finish_depths(const CameraModel& camera, const MeasurementKey& key, std::span<float> depth_m);

/// The models as labels. @throws Error(kBadFile) about `sensor` for a model beyond the 65535th.
std::vector<std::uint16_t> labels_of(std::span<const std::uint32_t> models, const Sensor& sensor);

/// The anchors of a world that are seen in an image of `width_px` columns whose pixels show these
/// models. Models that are nested in an anchor's belong to it.
std::vector<uav::SeenAnchor> find_anchors(const World& world, std::span<const std::uint32_t> models,
                                          int width_px);

}  // namespace tether::sim
