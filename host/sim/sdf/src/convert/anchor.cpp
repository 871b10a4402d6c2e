#include "convert/sdf_convert.h"

#include <algorithm>
#include <string_view>
#include <vector>

#include <tether/base/suggest.h>

namespace tether::sim {

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

}  // namespace

PlacedAnchor find_anchor(const SdfSource& source, const World& world, const std::string& name,
                         const FileLocation& requested_at) {
  const auto model = std::ranges::find(world.models, name, &Model::name);
  if (model == world.models.end()) refuse_unknown(source, world, name, requested_at);
  std::size_t visuals = 0;
  const Link* link = nullptr;
  for (const Link& candidate : model->links) {
    visuals += candidate.visuals.size();
    if (!candidate.visuals.empty()) link = &candidate;
  }
  if (visuals != 1) {
    refuse_anchor(source, name,
                  "has " + std::to_string(visuals) + " visuals; an anchor must have exactly one");
  }
  const Visual& visual = link->visuals.front();
  const auto shape = shape_and_size(visual.geometry);
  if (!shape) refuse_anchor(source, name, "is not a box, cylinder or sphere");
  if (!visual.material.albedo_map.empty()) {
    refuse_anchor(source, name, "has a texture; an anchor must have one colour, its <diffuse>");
  }
  return {{name, shape->first, shape->second, visual.material.diffuse_rgb},
          model->X_WM * link->X_ML * visual.X_LV};
}

}  // namespace tether::sim
