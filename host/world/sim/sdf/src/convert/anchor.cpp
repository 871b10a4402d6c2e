#include "convert/sdf_convert.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <tether/base/text.h>

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
  for (const Uav& uav : world.uavs) models.push_back(uav.name);
  const FileLocation where =
      requested_at.file.empty() ? FileLocation{source.file().string(), 0} : requested_at;
  throw Error(ErrorCode::kBadFile, where,
              "anchor '" + name + "' is neither a UAV nor a model of the world " +
                  source.file().string() + "; " + allowed_hint(name, models))
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

/// A visual, and its pose in the model or body.
using PlacedVisual = std::pair<const Visual*, Pose>;

std::vector<PlacedVisual> visuals_of(const Model& model) {
  std::vector<PlacedVisual> visuals;
  for (const Link& link : model.links)
    for (const Visual& visual : link.visuals)
      visuals.emplace_back(&visual, link.X_ML * visual.X_LV);
  return visuals;
}

/// A box along the axes of what it is in.
struct Around {
  uav::Vec3 middle, size_m;
};
/// Around boxes, cylinders and spheres; of turned ones, around the box around each.
Around box_around(const std::vector<PlacedVisual>& visuals) {
  constexpr double kLarge = std::numeric_limits<double>::infinity();
  uav::Vec3 least{kLarge, kLarge, kLarge}, most{-kLarge, -kLarge, -kLarge};
  for (const auto& [visual, X] : visuals) {
    const uav::Vec3 half = 0.5 * shape_and_size(visual->geometry)->second;
    const uav::Vec3 edges[] = {rotate(X.q, {half.x, 0, 0}), rotate(X.q, {0, half.y, 0}),
                               rotate(X.q, {0, 0, half.z})};
    for (double uav::Vec3::*axis : {&uav::Vec3::x, &uav::Vec3::y, &uav::Vec3::z}) {
      double reach = 0.0;
      for (const uav::Vec3& edge : edges) reach += std::abs(edge.*axis);
      least.*axis = std::min(least.*axis, X.p.*axis - reach);
      most.*axis = std::max(most.*axis, X.p.*axis + reach);
    }
  }
  return {0.5 * (least + most), most - least};
}

bool is_box_along_axes(const PlacedVisual& placed) {
  return std::holds_alternative<BoxGeometry>(placed.first->geometry) &&
         placed.second.q == uav::Quat{};
}

/// The box around what of its body has a shape, in the colour of the largest part.
PlacedAnchor anchor_of(const Uav& uav, const FileLocation& requested_at) {
  std::vector<PlacedVisual> visuals;
  const Visual* largest = nullptr;
  double largest_m3 = 0.0;
  for (const Visual& visual : uav.body.visuals) {
    const auto shape = shape_and_size(visual.geometry);
    if (!shape) continue;
    visuals.emplace_back(&visual, visual.X_LV);
    const double m3 = shape->second.x * shape->second.y * shape->second.z;
    if (m3 > largest_m3) largest = &visual;
    largest_m3 = std::max(largest_m3, m3);
  }
  if (largest == nullptr)
    throw Error(ErrorCode::kBadFile, requested_at,
                "the UAV '" + uav.name +
                    "' cannot be an anchor, because no visual of it is a box, cylinder or sphere")
        .about(uav.name);
  const Around around = box_around(visuals);
  return {{uav.name, uav::AnchorShape::kBox, around.size_m, largest->material.diffuse_rgb},
          uav.X_WB * Pose{around.middle, {}}};
}

}  // namespace

PlacedAnchor find_anchor(const SdfSource& source, const World& world, const std::string& name,
                         const FileLocation& requested_at) {
  const auto model = std::ranges::find(world.models, name, &Model::name);
  if (model == world.models.end()) {
    const auto uav = std::ranges::find(world.uavs, name, &Uav::name);
    if (uav == world.uavs.end()) refuse_unknown(source, world, name, requested_at);
    return anchor_of(*uav, requested_at);
  }
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
  if (!std::ranges::all_of(visuals, is_box_along_axes))
    refuse_anchor(source, name,
                  "has " + std::to_string(visuals.size()) +
                      " visuals; if an anchor has several, they must be boxes along its axes");
  const Around around = box_around(visuals);
  return {{name, uav::AnchorShape::kBox, around.size_m, color_rgb},
          model->X_WM * Pose{around.middle, {}}};
}

}  // namespace tether::sim
