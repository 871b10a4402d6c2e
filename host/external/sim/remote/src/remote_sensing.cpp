#include "remote_sensing.h"

#include <algorithm>
#include <cassert>
#include <optional>
#include <utility>

#include <tether/base/text.h>
#include <tether/sim_protocol/codec.h>

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
  request.max_m = std::min(bundle.max_m, kFarthestRay_m);
  for (std::size_t from = 0; from < bundle.rays_S.size(); from += protocol::kMaxRays) {
    const auto rays_S =
        bundle.rays_S.subspan(from, std::min(protocol::kMaxRays, bundle.rays_S.size() - from));
    request.rays_S.assign(rays_S.begin(), rays_S.end());
    const auto answer = session_.ask<protocol::Distances>(request);
    assert(answer.distance_m.size() == rays_S.size());
    std::ranges::copy(answer.distance_m, distances_m.subspan(from).begin());
  }
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
