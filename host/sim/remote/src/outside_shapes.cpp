#include "outside_shapes.h"

#include <cmath>
#include <utility>

namespace tether::sim {
namespace {

/// One of the parts that a shape falls into.
struct Part {
  std::string suffix;
  uav::Pose X;  ///< in the shape's own frame
  Geometry geometry;
};

std::vector<Part> parts_of(const Geometry& geometry) {
  if (const auto* capsule = std::get_if<CapsuleGeometry>(&geometry)) {
    const double half_m = 0.5 * capsule->length_m;
    const SphereGeometry end{capsule->radius_m};
    return {{"", {}, CylinderGeometry{capsule->radius_m, capsule->length_m}},
            {"_top", {{0.0, 0.0, half_m}, {}}, end},
            {"_bottom", {{0.0, 0.0, -half_m}, {}}, end}};
  }
  if (const auto* ellipsoid = std::get_if<EllipsoidGeometry>(&geometry)) {
    const uav::Vec3& r = ellipsoid->radii_m;
    return {{"", {}, SphereGeometry{std::cbrt(r.x * r.y * r.z)}}};
  }
  return {{"", {}, geometry}};
}

bool is_oblong(const Geometry& geometry) {
  const auto* ellipsoid = std::get_if<EllipsoidGeometry>(&geometry);
  if (!ellipsoid) return false;
  const uav::Vec3& r = ellipsoid->radii_m;
  return r.x != r.y || r.y != r.z;
}

/// Of what was merged from other links ("arm::box"), a name that no other shape of the UAV has.
std::string plain_name(const std::string& name, std::size_t index) {
  const std::size_t colons = name.find("::");
  if (colons == std::string::npos) return name;
  return "merged" + std::to_string(index) + "_" + name.substr(name.rfind(':') + 1);
}

template <class Shape>
std::vector<Shape> outside(const std::vector<Shape>& shapes, uav::Pose Shape::*pose,
                           const std::string& uav, const WarningSink& warn) {
  std::vector<Shape> out;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const Shape& shape = shapes[i];
    if (is_oblong(shape.geometry)) {
      warn("UAV '" + uav + "': the ellipsoid '" + shape.name +
           "' is a sphere of the same volume in a simulator outside: SDF 1.6 has no ellipsoid");
    }
    for (Part& part : parts_of(shape.geometry)) {
      Shape& added = out.emplace_back(shape);
      added.name = plain_name(shape.name, i) + part.suffix;
      added.*pose = shape.*pose * part.X;
      added.geometry = std::move(part.geometry);
    }
  }
  return out;
}

}  // namespace

std::vector<Visual> outside_visuals(const Uav& uav, const WarningSink& warn) {
  return outside(uav.body.visuals, &Visual::X_LV, uav.name, warn);
}

std::vector<Collision> outside_collisions(const Uav& uav, const WarningSink& warn) {
  return outside(uav.body.collisions, &Collision::X_LC, uav.name, warn);
}

}  // namespace tether::sim
