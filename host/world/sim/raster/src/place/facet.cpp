#include "place/facet.h"

#include <algorithm>
#include <cmath>

namespace tether::raster {
namespace {

using uav::Vec3;

// A plane over the picture, of a function that is linear in the ray (X, Y, 1).
std::array<float, 3> over_picture(const Vec3& linear, const Projection& p, double x_ref,
                                  double y_ref) {
  const double value =
      linear.x * ((x_ref - p.cx) / p.fx) + linear.y * ((y_ref - p.cy) / p.fy) + linear.z;
  return {static_cast<float>(value), static_cast<float>(linear.x / p.fx),
          static_cast<float>(linear.y / p.fy)};
}

// Whether no result computed with the plane becomes infinite.
bool is_usable(const std::array<float, 3>& plane) {
  constexpr float kSteepest = 1e15F;
  return std::abs(plane[0]) < kSteepest && std::abs(plane[1]) < kSteepest &&
         std::abs(plane[2]) < kSteepest;
}

std::array<float, 3> rotated(const std::array<float, 9>& r, const std::array<float, 3>& v) {
  return {r[0] * v[0] + r[1] * v[1] + r[2] * v[2], r[3] * v[0] + r[4] * v[1] + r[5] * v[2],
          r[6] * v[0] + r[7] * v[1] + r[8] * v[2]};
}

Vec3 vector(const std::array<float, 3>& v) {
  return {v[0], v[1], v[2]};
}

void set_coordinate(const Facet& facet, const std::array<float, 3>& corners, float texels,
                    Facet::Coordinate& out) {
  const float second = corners[1] - corners[0];
  const float third = corners[2] - corners[0];
  out.first = corners[0];
  out.low = std::min({0.0F, second, third});
  out.high = std::max({0.0F, second, third});
  for (std::size_t i = 0; i < 3; ++i) {
    out.added[i] = second * facet.second[i] + third * facet.third[i];
  }
  for (std::size_t i = 0; i < 2; ++i) {
    out.change[i] = texels * out.added[i + 1];
    out.shrinkage[i] = texels * facet.depth.plane[i + 1];
  }
}

void set_normal(const PlacedVisual& visual, const VertexLook& a, const VertexLook& b,
                const VertexLook& c, Facet& facet) {
  const auto na = rotated(visual.rotation, a.normal);
  facet.is_flat = a.normal == b.normal && a.normal == c.normal;
  if (facet.is_flat) {
    for (std::size_t i = 0; i < 3; ++i) facet.normal[i] = {na[i], 0.0F, 0.0F};
    return;
  }
  const auto nb = rotated(visual.rotation, b.normal);
  const auto nc = rotated(visual.rotation, c.normal);
  for (std::size_t i = 0; i < 3; ++i) facet.normal[i] = {na[i], nb[i] - na[i], nc[i] - na[i]};
}

}  // namespace

// With the corners as columns of M, M⁻¹·(X, Y, 1) are the corners' weights over z. Their sum is
// 1/z.
DepthPlane depth_of(const std::array<std::array<float, 3>, 3>& corners,
                    const Projection& projection, const FixedRect& seen) {
  const std::int32_t x = (seen.x_low + seen.x_high) / 2;
  const std::int32_t y = (seen.y_low + seen.y_high) / 2;
  const double x_ref = static_cast<double>(x) / kSubpixels;
  const double y_ref = static_cast<double>(y) / kSubpixels;
  const Vec3 a = vector(corners[0]);
  const Vec3 b = vector(corners[1]);
  const Vec3 c = vector(corners[2]);
  const Vec3 normal = cross(b - a, c - a);
  const double scale = 1.0 / dot(a, normal);
  const double low = 1.0 / std::max({a.z, b.z, c.z});
  const double high = 1.0 / std::max(projection.near_m, std::min({a.z, b.z, c.z}));
  DepthPlane depth{static_cast<float>(x_ref), static_cast<float>(y_ref),
                   over_picture(scale * normal, projection, x_ref, y_ref), static_cast<float>(low),
                   static_cast<float>(high)};
  // A triangle that is seen edge-on has constant values.
  if (!is_usable(depth.plane)) depth.plane = {depth.high, 0.0F, 0.0F};
  return depth;
}

Facet make_facet(const PreparedScene& scene, const Layer& layer, const Coverage& coverage) {
  const PlacedVisual& visual = layer.visuals[coverage.visual];
  const Vec3 a = vector(coverage.corners[0]);
  const Vec3 b = vector(coverage.corners[1]);
  const Vec3 c = vector(coverage.corners[2]);
  const double scale = 1.0 / dot(a, cross(b - a, c - a));
  Facet facet{};
  facet.depth = coverage.depth;
  const auto over = [&](const Vec3& linear) {
    return over_picture(scale * linear, layer.projection, static_cast<double>(facet.depth.x_ref),
                        static_cast<double>(facet.depth.y_ref));
  };
  facet.second = over(cross(c, a));
  facet.third = over(cross(a, b));
  if (!is_usable(facet.second) || !is_usable(facet.third)) {
    facet.second = facet.third = {facet.depth.high / 3.0F, 0.0F, 0.0F};
  }
  const auto& corners = scene.triangles[coverage.triangle];
  const auto look = [&](std::size_t i) -> const VertexLook& {
    return scene.looks[visual.first_look + corners[i]];
  };
  const MaterialRow& material = scene.materials[visual.material];
  set_coordinate(facet, {look(0).uv[0], look(1).uv[0], look(2).uv[0]}, material.texture_width,
                 facet.u);
  set_coordinate(facet, {look(0).uv[1], look(1).uv[1], look(2).uv[1]}, material.texture_height,
                 facet.v);
  set_normal(visual, look(0), look(1), look(2), facet);
  facet.material = visual.material;
  return facet;
}

}  // namespace tether::raster
