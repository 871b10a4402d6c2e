#include "remote_sensing.h"

#include <algorithm>
#include <cassert>
#include <optional>
#include <utility>

#include <tether/base/printable.h>

namespace tether::sim {
namespace {

/// In place of infinity: a float still resolves metres at this distance.
constexpr double kFarthestRay_m = 1e6;

std::optional<std::uint32_t> index(std::optional<std::size_t> body) {
  if (!body) return std::nullopt;
  return static_cast<std::uint32_t>(*body);
}

}  // namespace

void RemoteRays::cast(const RayBundle& bundle, std::span<double> distances_m) {
  protocol::CastRays request;
  request.X_WB.assign(bundle.X_WB.begin(), bundle.X_WB.end());
  request.carrier = index(bundle.ignored);
  request.X_WS = bundle.X_WS;
  request.rays_S.assign(bundle.rays_S.begin(), bundle.rays_S.end());
  request.max_m = std::min(bundle.max_m, kFarthestRay_m);
  const auto answer = session_.ask<protocol::Distances>(request);
  assert(answer.distance_m.size() == distances_m.size());
  std::copy(answer.distance_m.begin(), answer.distance_m.end(), distances_m.begin());
}

void RemoteRenderer::render(const View& view, std::span<std::uint8_t> rgb) {
  protocol::Render request;
  request.camera = view.camera;
  request.near_m = view.near_m;
  request.far_m = view.far_m;
  request.X_WS = view.X_WS;
  request.X_WB.assign(view.X_WB.begin(), view.X_WB.end());
  request.hidden = index(view.hidden);
  request.with_depth = view.with_depth;
  const auto picture = session_.ask<protocol::Picture>(request);
  assert(picture.rgb.size() == rgb.size());
  std::copy(picture.rgb.begin(), picture.rgb.end(), rgb.begin());
  nearest_depth_m_ = std::clamp(picture.nearest_depth_m, view.near_m, view.far_m);
  name_ = printable(picture.renderer);
}

}  // namespace tether::sim
