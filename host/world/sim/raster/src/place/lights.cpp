#include "place/lights.h"

#include "scene/trigonometry.h"

#include <algorithm>
#include <numbers>

namespace tether::raster {
namespace {

using uav::Pose;
using uav::Vec3;

std::array<float, 3> floats(const Vec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

std::array<LightRow::Splat, 3> splat(const std::array<float, 3>& numbers) {
  std::array<LightRow::Splat, 3> all;
  for (std::size_t i = 0; i < 3; ++i) all[i].fill(numbers[i]);
  return all;
}

LightRow make_row(const Light& light, const Pose& X_CW) {
  LightRow row;
  constexpr float kLeastLoss = 1e-9F;  // what a light gives stays finite
  row.position = splat(floats(transform(X_CW, light.p_WL)));
  row.direction = splat(floats(rotate(X_CW.q, light.direction_W)));
  row.diffuse = splat(light.diffuse);
  row.specular = splat(light.specular);
  row.attenuation = splat({std::max(light.attenuation_constant, kLeastLoss),
                           light.attenuation_linear, light.attenuation_quadratic});
  row.is_directional = light.kind == LightKind::kDirectional;
  row.has_specular =
      std::any_of(light.specular.begin(), light.specular.end(), [](float c) { return c > 0.0F; });
  if (light.kind == LightKind::kSpot) {
    const double angle = std::clamp(light.spot_half_angle_rad, 0.0, 0.5 * std::numbers::pi);
    row.cos_cutoff = static_cast<float>(cosine(angle));
    row.exponent = light.spot_exponent;
  }
  return row;
}

// The map's matrix for points in C.
std::array<float, 12> from_camera(const std::array<double, 12>& from_world, const Pose& X_WC) {
  const uav::Quat q_CW = uav::inverse(X_WC.q);
  std::array<float, 12> out{};
  for (std::size_t i = 0; i < 12; i += 4) {
    const Vec3 normal{from_world[i], from_world[i + 1], from_world[i + 2]};
    const std::array<float, 3> turned = floats(rotate(q_CW, normal));
    std::copy(turned.begin(), turned.end(), out.begin() + static_cast<std::ptrdiff_t>(i));
    out[i + 3] = static_cast<float>(dot(normal, X_WC.p) + from_world[i + 3]);
  }
  return out;
}

}  // namespace

void place_lights(const PreparedScene& scene, const std::vector<ShadowMap>& shadows, Layer& layer) {
  layer.lights.clear();
  std::int32_t map = 0;
  for (const Light& light : scene.lights) {
    LightRow& row = layer.lights.emplace_back(make_row(light, layer.X_CW));
    if (!light.cast_shadows || shadows.empty()) continue;
    row.shadow = map;
    for (std::array<float, 12>& to : row.to_shadow) {
      const ShadowMap& of_light = shadows[static_cast<std::size_t>(map++)];
      to = from_camera(of_light.from_world(), inverse(layer.X_CW));
    }
  }
  layer.only_points = std::all_of(layer.lights.begin(), layer.lights.end(), [](const LightRow& l) {
    return !l.is_directional && l.cos_cutoff < -1.0F && l.shadow < 0;
  });
  layer.any_specular = std::any_of(layer.lights.begin(), layer.lights.end(),
                                   [](const LightRow& l) { return l.has_specular; });
  for (std::size_t i = 1; i < layer.lights.size(); ++i) {
    const LightRow& light = layer.lights[i];
    LightRow& last = layer.lights[i - 1];
    last.is_last_of_colour = last.diffuse != light.diffuse || last.specular != light.specular;
  }
}

}  // namespace tether::raster
