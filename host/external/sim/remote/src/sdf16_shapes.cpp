#include "sdf16_shapes.h"

#include <cmath>
#include <utility>

namespace tether::sim {
namespace {

/// One of the parts that replace a shape.
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

/// Whether it is an ellipsoid that is not a ball.
bool is_oblong(const Geometry& geometry) {
  const auto* ellipsoid = std::get_if<EllipsoidGeometry>(&geometry);
  return ellipsoid && (ellipsoid->radii_m.x != ellipsoid->radii_m.y ||
                       ellipsoid->radii_m.y != ellipsoid->radii_m.z);
}

/// A unique name for a shape that was merged from another link ("arm::box").
std::string plain_name(const std::string& name, std::size_t index) {
  const std::size_t colons = name.find("::");
  if (colons == std::string::npos) return name;
  return "merged" + std::to_string(index) + "_" + name.substr(name.rfind(':') + 1);
}

template <class Shape>
std::vector<Shape> in_sdf16(const std::vector<Shape>& shapes, uav::Pose Shape::*pose,
                            const std::string& uav, const WarningSink& warn) {
  std::vector<Shape> out;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const Shape& shape = shapes[i];
    if (is_oblong(shape.geometry)) {
      warn({Consequence::kLooksDifferent,
            {},
            "ellipsoid '" + shape.name + "'",
            "of UAV '" + uav +
                "' is a sphere of the same volume for external simulators, because "
                "SDF 1.6 has no ellipsoid"});
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

std::vector<Visual> sdf16_visuals(const Uav& uav, const WarningSink& warn) {
  return in_sdf16(uav.body.visuals, &Visual::X_LV, uav.name, warn);
}

std::vector<Collision> sdf16_collisions(const Uav& uav, const WarningSink& warn) {
  return in_sdf16(uav.body.collisions, &Collision::X_LC, uav.name, warn);
}

}  // namespace tether::sim
