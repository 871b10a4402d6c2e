#pragma once

#include <chrono>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include <tether/sim_protocol/codec.h>
#include <tether/sim_protocol/messages.h>
#include <tether/uav/fields.h>
#include <tether/wire/fields.h>

/// The fields of each message: tether/wire/fields.h. The schema `schema/simulator.fbs` has the
/// same.
namespace tether::wire {

template <>
inline constexpr bool kIsStruct<sim::protocol::Command> = true;
template <>
inline constexpr bool kIsStruct<sim::protocol::Motion> = true;

}  // namespace tether::wire

namespace tether::sim::protocol {

using wire::AtMost;
using wire::Is;
using wire::Rule;

inline constexpr AtMost kAnyBodies{kMaxBodies, "has too many bodies"};
inline constexpr AtMost kName{kMaxNameBytes};
inline constexpr AtMost kText{kMaxTextBytes};

/// Of the field `width_px` and the next one.
void require_size(auto& io, const auto& width_px, const auto& height_px, std::int32_t least) {
  io.require(
      [&] {
        return width_px >= least && height_px >= least && width_px <= kMaxSidePx &&
               height_px <= kMaxSidePx && std::int64_t{width_px} * height_px <= kMaxPixels;
      },
      "width_px, height_px", "are not a valid picture size");
}
void require_body(auto& io, const std::optional<std::uint32_t>& index, const auto& bodies,
                  const char* name) {
  io.require([&] { return !index || *index < bodies.size(); }, name, "is not the index of a body");
}

// --- Open ---------------------------------------------------------------------------------------

void fields(auto& io, Is<UavDescription> auto& m) {
  io.here([&m] { return "Open.uavs '" + m.name + "': "; });
  io("name", m.name, kName, wire::kNotEmpty);
  io("sdf", m.sdf, AtMost{kMaxSdfBytes});
  io("x_wb", m.X_WB);
  io("airframe", m.airframe);
}

void fields(auto& io, Is<BodyName> auto& m) {
  io("model", m.model, kName);
  io("link", m.link, kName);
}

void fields(auto& io, Is<VisualMaterial> auto& m) {
  const auto color = uav::of_each_part(wire::kShare);
  io.here([&m] { return "Open.looks '" + m.model + "': "; });
  io("model", m.model, kName);
  io("link", m.link, kName);
  io("visual", m.visual, kName);
  io("ambient_rgb", m.ambient_rgb, color);
  io("diffuse_rgb", m.diffuse_rgb, color);
  io("specular_rgb", m.specular_rgb, color);
  io("emissive_rgb", m.emissive_rgb, color);
  io("texture", m.texture, kText);
  io("texture_repeat_x", m.texture_repeat_x, wire::kPositive);
  io("texture_repeat_y", m.texture_repeat_y, wire::kPositive);
  io("alpha", m.alpha, wire::Default{1.0}, wire::kShare);
}

void fields(auto& io, Is<Open> auto& m) {
  const Rule step{[](Duration d) { return d > Duration(0) && d <= std::chrono::seconds(1); },
                  "is not within 1 ns..1 s"};
  const auto bodies = [&m] { return m.uavs.size() + m.bodies.size(); };
  io.here("Open.");
  io("version", m.version);
  io("world_name", m.world_name, kName);
  io("world_file", m.world_file, kText);
  io("gravity_m_s2", m.gravity_m_s2, wire::kNotNegative);
  io("step_ns", m.step, step);
  io("uavs", m.uavs, kAnyBodies);
  io("bodies", m.bodies, kAnyBodies);
  io("past_steps", m.past_steps);
  io("max_width_px", m.max_width_px);
  io("max_height_px", m.max_height_px);
  io("looks", m.materials, AtMost{kMaxMaterials, "are too many"});
  io.require([&] { return bodies() <= kMaxBodies; }, "uavs, bodies", "are too many together");
  io.require([&] { return m.past_steps * bodies() <= kMaxPastPoses; }, "past_steps",
             "makes too many past poses");
  require_size(io, m.max_width_px, m.max_height_px, 0);
}

// --- the other requests -------------------------------------------------------------------------

void fields(auto& io, Is<Reset> auto& m) {
  io("seed", m.seed);
}

constexpr void fields(auto& io, Is<Command> auto& m) {
  io("velocity_h_m_s", m.command.velocity_H_m_s);
  io("yaw_rate_rad_s", m.command.yaw_rate_rad_s);
  io("uav", m.uav);
  io.require([&m] { return m.uav < kMaxBodies; }, "uav", "have an unknown UAV index");
  io.require([&m] { return complaint_about(to_setpoint(m.command)).empty(); }, "command",
             "are not valid velocity commands");
}
void fields(auto& io, Is<SetpointCommand> auto& m) {
  io.here("Advance.setpoints: ");
  io("uav", m.uav, Rule{[](std::uint32_t uav) { return uav < kMaxBodies; }, "is unknown"});
  io("setpoint", m.setpoint);
}
void fields(auto& io, Is<Advance> auto& m) {
  io.here("Advance.");
  io("to_st_ns", m.to);
  io("commands", m.commands, AtMost{kMaxBodies, "are too many"});
  io("setpoints", m.setpoints, wire::OmitEmpty{}, AtMost{kMaxBodies, "are too many"});
}

void fields(auto& io, Is<CastRays> auto& m) {
  const Rule some{[](const auto& rays) { return !rays.empty(); }, "are none"};
  const Rule unit{[](const std::vector<uav::Vec3>& rays) {
                    for (const uav::Vec3& ray : rays)
                      if (!(std::abs(dot(ray, ray) - 1.0) < 1e-6)) return false;
                    return true;
                  },
                  "are not of unit length"};
  io.here("CastRays.");
  io("x_wb", m.X_WB, kAnyBodies);
  io("carrier", m.carrier);
  io("x_ws", m.X_WS);
  io("rays_s", m.rays_S, AtMost{kMaxRays, "are too many"}, some, unit);
  io("max_m", m.max_m, wire::kPositive);
  require_body(io, m.carrier, m.X_WB, "carrier");
}

void fields(auto& io, Is<Render> auto& m) {
  io.here("Render.");
  io("width_px", m.camera.width_px);
  io("height_px", m.camera.height_px);
  io("focal_px", m.camera.fx_px, wire::kPositive);
  if constexpr (!std::is_const_v<std::remove_reference_t<decltype(m)>>)
    m.camera.fy_px = m.camera.fx_px;
  io.require([&m] { return m.camera.fy_px == m.camera.fx_px && !m.camera.has_distortion(); },
             "camera", "is not an ideal camera with square pixels");
  io("cx_px", m.camera.cx_px);
  io("cy_px", m.camera.cy_px);
  io("near_m", m.near_m, wire::kPositive);
  io("far_m", m.far_m);
  io("x_ws", m.X_WS);
  io("x_wb", m.X_WB, kAnyBodies);
  io("hidden", m.hidden);
  io("with_depth", m.with_depth);
  require_size(io, m.camera.width_px, m.camera.height_px, 1);
  io.require([&m] { return m.far_m > m.near_m; }, "far_m", "is not beyond near_m");
  require_body(io, m.hidden, m.X_WB, "hidden");
}

// --- replies ------------------------------------------------------------------------------------

constexpr void fields(auto& io, Is<Motion> auto& m) {
  io("a_wb_w", m.a_WB_W);
  io("alpha_wb_b", m.alpha_WB_B);
}
void fields(auto& io, Is<Touch> auto& m) {
  io.here("State.touches: ");
  io("at_st_ns", m.at);
  io("uav", m.uav);
  io("with", m.with, kName, wire::kNotEmpty);
  io("shape", m.shape);
  io("speed_m_s", m.speed_m_s);
}
void fields(auto& io, Is<State> auto& m) {
  io.here("State.");
  io("now_st_ns", m.now);
  io("bodies", m.bodies, kAnyBodies);
  io("motions", m.motions, kAnyBodies);
  io("past", m.past, AtMost{kMaxPastPoses, "has too many poses"});
  io("touches", m.touches, wire::OmitEmpty{}, AtMost{kMaxTouches, "are too many"});
  io.require([&m] { return m.motions.size() <= m.bodies.size(); }, "motions",
             "are more than the bodies");
}
void fields(auto& io, Is<Opened> auto& m) {
  io.here("Opened.");
  io("description", m.description, kText);
  io("state", m.state);
  io("reports_contacts", m.reports_contacts);
  io("takes_setpoints", m.takes_setpoints);
}

void fields(auto& io, Is<Distances> auto& m) {
  // False for NaN.
  const Rule distances{[](const std::vector<double>& all) {
                         for (const double distance : all)
                           if (!(distance >= 0.0)) return false;
                         return true;
                       },
                       "has what is not a distance"};
  io.here("Distances.");
  io("distance_m", m.distance_m, wire::AnyNumber{}, AtMost{kMaxRays, "has too many rays"},
     distances);
}

void fields(auto& io, Is<Picture> auto& m) {
  io.here("Picture.");
  io("width_px", m.width_px);
  io("height_px", m.height_px);
  io("rgb", m.rgb, wire::Apart{});
  io("nearest_depth_m", m.nearest_depth_m, wire::kNotNegative);
  io("renderer", m.renderer, kText);
  require_size(io, m.width_px, m.height_px, 1);
  io.require(
      [&m] {
        return std::int64_t{m.width_px} * m.height_px * 3 ==
               static_cast<std::int64_t>(m.rgb.size());
      },
      "rgb", "is not of width_px x height_px x 3 bytes");
}

void fields(auto& io, Is<Failed> auto& m) {
  io.here("Failed.");
  io("message", m.message, kText);
}

}  // namespace tether::sim::protocol
