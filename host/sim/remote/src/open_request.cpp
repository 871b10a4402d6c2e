#include "open_request.h"

#include "outside_shapes.h"
#include "sdf_text.h"

#include <string>

#include <tether/base/error.h>
#include <tether/sim_sensing/sensor_suite.h>
#include <tether/sim_sensing/state_layout.h>

namespace tether::sim {
namespace {

using protocol::Look;

void add_look(const std::string& model, const std::string& link, const Visual& visual,
              std::vector<Look>& looks) {
  const Material& m = visual.material;
  if (m.albedo_map.empty()) return;
  looks.push_back({model, link, visual.name, m.ambient_rgb, m.diffuse_rgb, m.specular_rgb,
                   m.emissive_rgb, m.albedo_map.string(), m.texture_repeat_x, m.texture_repeat_y,
                   m.alpha});
}

/// SDF's own materials every simulator reads by itself; textures it reads as it likes.
std::vector<Look> looks_of(const World& world) {
  std::vector<Look> looks;
  for (const Uav& uav : world.uavs) {
    for (const Visual& v : outside_visuals(uav, [](const std::string&) {})) {
      add_look(uav.name, "base_link", v, looks);
    }
  }
  for (const Model& model : world.models) {
    for (const Link& link : model.links) {
      for (const Visual& visual : link.visuals) add_look(model.name, link.name, visual, looks);
    }
  }
  return looks;
}

/// In the order of `moving_bodies`, behind the UAVs.
std::vector<protocol::BodyName> body_names(const World& world) {
  std::vector<protocol::BodyName> names;
  for (const Model& model : world.models) {
    if (model.is_static) continue;
    for (const Link& link : model.links) names.push_back({model.name, link.name});
  }
  return names;
}

}  // namespace

protocol::Open make_open(const World& world, const WarningSink& warn) {
  if (world.file.empty()) {
    throw Error(ErrorCode::kBadFile,
                "world '" + world.name + "' comes from no file; a simulator outside reads one");
  }
  const ViewSize size = largest_view(world);
  protocol::Open open;
  open.world_name = world.name;
  open.world_file = world.file.string();
  open.gravity_m_s2 = world.gravity_m_s2;
  open.step = world.step;
  for (const Uav& uav : world.uavs) {
    open.uavs.push_back({uav.name, to_sdf(uav, warn), uav.X_WB, uav.airframe});
  }
  open.bodies = body_names(world);
  open.past_steps = static_cast<std::uint32_t>(shutter_steps(world));
  open.max_width_px = size.width_px;
  open.max_height_px = size.height_px;
  open.looks = looks_of(world);
  return open;
}

}  // namespace tether::sim
