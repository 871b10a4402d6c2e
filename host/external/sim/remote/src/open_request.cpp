#include "open_request.h"

#include "sdf16_shapes.h"
#include "sdf_text.h"

#include <string>

#include <tether/base/error.h>
#include <tether/sim/bodies.h>
#include <tether/sim_remote/remote_simulator.h>
#include <tether/sim_sensing/state_layout.h>
#include <tether/sim_sensing/view_renderer.h>

namespace tether::sim {
namespace {

using protocol::VisualMaterial;

void add_material(const std::string& model, const std::string& link, const Visual& visual,
                  std::vector<VisualMaterial>& materials) {
  const Material& m = visual.material;
  if (m.albedo_map.empty()) return;
  materials.push_back({model, link, visual.name, m.ambient_rgb, m.diffuse_rgb, m.specular_rgb,
                       m.emissive_rgb, m.albedo_map.string(), m.texture_repeat_x,
                       m.texture_repeat_y, m.alpha});
}

/// Of the textured visuals. Simulators read SDF's own materials themselves.
std::vector<VisualMaterial> materials_of(const World& world) {
  std::vector<VisualMaterial> materials;
  for (const Uav& uav : world.uavs) {
    for (const Visual& v : sdf16_visuals(uav, [](const Warning&) {})) {
      add_material(uav.name, "base_link", v, materials);
    }
  }
  for (const Model& model : world.models) {
    for (const Link& link : model.links) {
      for (const Visual& v : link.visuals)
        if (!v.material.is_of_script) add_material(model.name, link.name, v, materials);
    }
  }
  return materials;
}

void require_remote_camera(const Uav& uav, const Sensor& sensor, const CameraModel& camera) {
  if (camera.kind != uav::CameraKind::kColor) {
    throw Error(ErrorCode::kBadFile, sensor.declared_at,
                "sensor '" + sensor.name + "' of UAV '" + uav.name + "' is a " +
                    std::string(uav::name(camera.kind)) +
                    ", which external simulators do not have; use the embedded simulator, or a "
                    "UAV model without this sensor")
        .about(sensor.name);
  }
  if (camera.antialias) {
    throw Error(ErrorCode::kBadFile, camera.antialias_at,
                "the camera '" + sensor.name + "' of UAV '" + uav.name +
                    "' has antialias = true, which external simulators do not support; use the "
                    "embedded simulator, or antialias = false")
        .about("antialias");
  }
}

}  // namespace

void require_remote_cameras(const World& world) {
  for (const Uav& uav : world.uavs) {
    for (const Sensor& sensor : uav.sensors) {
      const auto* camera = std::get_if<CameraModel>(&sensor.model);
      if (camera != nullptr) require_remote_camera(uav, sensor, *camera);
    }
  }
}

protocol::Open make_open(const World& world, const WarningSink& warn) {
  if (world.file.empty()) {
    throw Error(ErrorCode::kBadFile,
                "world '" + world.name + "' has no file; external simulators read the world's file")
        .about(world.name);
  }
  require_remote_cameras(world);
  if (!world.wind.is_calm())
    warn({Consequence::kBehavesDifferent,
          {world.file.string()},
          "<wind>",
          "has no effect: only the embedded simulator simulates wind"});
  if (world.gravity_x_m_s2 != 0.0 || world.gravity_y_m_s2 != 0.0)
    warn({Consequence::kBehavesDifferent,
          {world.file.string()},
          "<gravity>",
          "points straight down: only the embedded simulator simulates a tilted one"});
  const ViewSize size = largest_view(world);
  protocol::Open open;
  open.world_name = world.name;
  open.world_file = world.file.string();
  open.gravity_m_s2 = world.gravity_m_s2;
  open.step = world.step;
  for (const Uav& uav : world.uavs) {
    open.uavs.push_back({uav.name, to_sdf(uav, warn), uav.X_WB, uav.airframe});
  }
  for (const MovingBody& body : moving_bodies(world)) {
    if (!body.uav) open.bodies.push_back({body.model->name, body.link->name});
  }
  open.past_steps = static_cast<std::uint32_t>(shutter_steps(world));
  open.max_width_px = size.width_px;
  open.max_height_px = size.height_px;
  open.materials = materials_of(world);
  return open;
}

}  // namespace tether::sim
