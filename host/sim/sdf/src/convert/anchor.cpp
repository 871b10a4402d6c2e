#include "convert/sdf_convert.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <tether/base/suggest.h>

namespace tether::sim {

using uav::Pose;

namespace {

[[noreturn]] void refuse_anchor(const SdfSource& source, const std::string& name,
                                const std::string& message) {
  sdf::ElementPtr model = source.root().WorldByIndex(0)->Element()->FindElement("model");
  while (model && name_attribute(model) != name) model = model->GetNextElement("model");
  const FileLocation where = model ? source.where(model) : FileLocation{source.file().string(), 0};
  throw Error(ErrorCode::kBadFile, where, "anchor '" + name + "' " + message).about(name);
}

[[noreturn]] void refuse_unknown(const SdfSource& source, const World& world,
                                 const std::string& name, const FileLocation& requested_at) {
  std::vector<std::string_view> models;
  for (const Model& model : world.models) models.push_back(model.name);
  const FileLocation where =
      requested_at.file.empty() ? FileLocation{source.file().string(), 0} : requested_at;
  throw Error(ErrorCode::kBadFile, where,
              "anchor '" + name + "' is not a model of the world " + source.file().string() + "; " +
                  allowed_hint(name, models))
      .about(name);
}

/// None if SUTs do not know the shape.
std::optional<std::pair<uav::AnchorShape, uav::Vec3>> shape_and_size(const Geometry& geometry) {
  using uav::AnchorShape;
  if (const auto* box = std::get_if<BoxGeometry>(&geometry))
    return std::pair(AnchorShape::kBox, box->size_m);
  if (const auto* c = std::get_if<CylinderGeometry>(&geometry))
    return std::pair(AnchorShape::kCylinder,
                     uav::Vec3{2.0 * c->radius_m, 2.0 * c->radius_m, c->length_m});
  if (const auto* sphere = std::get_if<SphereGeometry>(&geometry))
    return std::pair(AnchorShape::kSphere, 2.0 * sphere->radius_m * uav::Vec3{1.0, 1.0, 1.0});
  return std::nullopt;
}

/// The visuals of the model, with their poses in it.
std::vector<std::pair<const Visual*, Pose>> visuals_of(const Model& model) {
  std::vector<std::pair<const Visual*, Pose>> visuals;
  for (const Link& link : model.links)
    for (const Visual& visual : link.visuals)
      visuals.emplace_back(&visual, link.X_ML * visual.X_LV);
  return visuals;
}

/// The box around boxes that are parallel to the model's axes, and its middle in the model.
struct Around {
  uav::Vec3 middle_M, size_m;
};
std::optional<Around> box_around(const std::vector<std::pair<const Visual*, Pose>>& visuals) {
  constexpr double kLarge = std::numeric_limits<double>::infinity();
  uav::Vec3 least{kLarge, kLarge, kLarge}, most{-kLarge, -kLarge, -kLarge};
  for (const auto& [visual, X_MV] : visuals) {
    const auto* box = std::get_if<BoxGeometry>(&visual->geometry);
    if (box == nullptr || X_MV.q != uav::Quat{}) return std::nullopt;
    const uav::Vec3 half = 0.5 * box->size_m;
    for (double uav::Vec3::*axis : {&uav::Vec3::x, &uav::Vec3::y, &uav::Vec3::z}) {
      least.*axis = std::min(least.*axis, X_MV.p.*axis - half.*axis);
      most.*axis = std::max(most.*axis, X_MV.p.*axis + half.*axis);
    }
  }
  return Around{0.5 * (least + most), most - least};
}

}  // namespace

PlacedAnchor find_anchor(const SdfSource& source, const World& world, const std::string& name,
                         const FileLocation& requested_at) {
  const auto model = std::ranges::find(world.models, name, &Model::name);
  if (model == world.models.end()) refuse_unknown(source, world, name, requested_at);
  const auto visuals = visuals_of(*model);
  if (visuals.empty()) refuse_anchor(source, name, "has no visual; an anchor must be visible");
  const auto& [first, X_MV] = visuals.front();
  for (const auto& [visual, X_MV_other] : visuals) {
    if (!visual->material.albedo_map.empty())
      refuse_anchor(source, name, "has a texture; an anchor must have one colour, its <diffuse>");
    if (visual->material.diffuse_rgb != first->material.diffuse_rgb)
      refuse_anchor(source, name, "has several colours; give all its visuals one <diffuse>");
  }
  const uav::Vec3 color_rgb = first->material.diffuse_rgb;
  if (visuals.size() == 1) {
    const auto shape = shape_and_size(first->geometry);
    if (!shape) refuse_anchor(source, name, "is not a box, cylinder or sphere");
    return {{name, shape->first, shape->second, color_rgb}, model->X_WM * X_MV};
  }
  const auto around = box_around(visuals);
  if (!around)
    refuse_anchor(source, name,
                  "has " + std::to_string(visuals.size()) +
                      " visuals; if an anchor has several, they must be boxes along its axes");
  return {{name, uav::AnchorShape::kBox, around->size_m, color_rgb},
          model->X_WM * Pose{around->middle_M, {}}};
}

}  // namespace tether::sim
