// The rules of each message: one `check` for each type, with the name of the field that is wrong.
// Both ends apply them before sending and after decoding.

#include <cmath>
#include <string>
#include <string_view>

#include <tether/link/field_checker.h>
#include <tether/sim_protocol/codec.h>

namespace tether::sim::protocol {
namespace {

using Checker = link::FieldChecker;

// --- numbers ------------------------------------------------------------------------------------

void positive(Checker& c, double value, std::string_view field) {
  c.require(std::isfinite(value) && value > 0.0, field, "is not a positive number");
}
void not_negative(Checker& c, double value, std::string_view field) {
  c.require(std::isfinite(value) && value >= 0.0, field, "is not a number of at least 0");
}
/// Rotations are used without being normalised.
void unit(Checker& c, double squared_norm, std::string_view field) {
  c.require(std::abs(squared_norm - 1.0) < 1e-6, field, "is not of unit length");
}
void check(Checker& c, const uav::Quat& q, std::string_view field) {
  unit(c, q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z, field);
}
void check(Checker& c, const uav::Pose& X, std::string_view field) {
  c.finite(X.p, field);
  check(c, X.q, field);
}
void check(Checker& c, const std::vector<uav::Pose>& poses, std::string_view field) {
  c.require(poses.size() <= kMaxBodies, field, "has too many bodies");
  for (const uav::Pose& X : poses) check(c, X, field);
}
void share(Checker& c, double value, std::string_view field) {
  c.require(value >= 0.0 && value <= 1.0, field, "is not within 0..1");
}
void color(Checker& c, const uav::Vec3& rgb, std::string_view field) {
  for (const double part : {rgb.x, rgb.y, rgb.z}) share(c, part, field);
}
void body(Checker& c, const std::optional<std::uint32_t>& index, std::size_t bodies,
          std::string_view field) {
  c.require(!index || *index < bodies, field, "is not the index of a body");
}
void size(Checker& c, std::int32_t width_px, std::int32_t height_px, std::int32_t least) {
  const bool within = width_px >= least && height_px >= least && width_px <= kMaxSidePx &&
                      height_px <= kMaxSidePx && std::int64_t{width_px} * height_px <= kMaxPixels;
  c.require(within, "width_px, height_px", "are not a valid picture size");
}

void name(Checker& c, const std::string& value, std::string_view field) {
  c.text(value, kMaxNameBytes, field);
}
void text(Checker& c, const std::string& value, std::string_view field) {
  c.text(value, kMaxTextBytes, field);
}

// --- Open ---------------------------------------------------------------------------------------

void check(Checker& c, const uav::MultirotorParameters& p) {
  positive(c, p.mass_kg, "mass_kg");
  for (const double part : {p.inertia_kg_m2.x, p.inertia_kg_m2.y, p.inertia_kg_m2.z}) {
    positive(c, part, "inertia_kg_m2");
  }
  c.require(!p.rotors.empty() && p.rotors.size() <= uav::MultirotorState::kMaxRotors, "rotors",
            "are not 1 to 8");
  for (const uav::Rotor& rotor : p.rotors) {
    c.finite(rotor.p_BR, "rotors");
    c.require(rotor.direction == 1 || rotor.direction == -1, "rotors",
              "have a direction other than 1 or -1");
  }
  for (const double value :
       {p.thrust_coefficient, p.moment_coefficient_m, p.drag_coefficient, p.linear_drag_N_s_m,
        p.max_rotor_speed_rad_s, p.time_constant_up_s, p.time_constant_down_s, p.max_tilt_rad,
        p.max_horizontal_speed_m_s, p.max_vertical_speed_m_s, p.max_yaw_rate_rad_s,
        p.max_acceleration_m_s2, p.max_yaw_acceleration_rad_s2}) {
    not_negative(c, value, "airframe");
  }
}

void check(Checker& c, const UavDescription& uav) {
  c.in("Open.uavs '" + uav.name + "': ");
  name(c, uav.name, "name");
  c.require(!uav.name.empty(), "name", "is empty");
  c.text(uav.sdf, kMaxSdfBytes, "sdf");
  check(c, uav.X_WB, "X_WB");
  check(c, uav.airframe);
}

void check(Checker& c, const VisualMaterial& look) {
  c.in("Open.looks '" + look.model + "': ");
  name(c, look.model, "model");
  name(c, look.link, "link");
  name(c, look.visual, "visual");
  color(c, look.ambient_rgb, "ambient_rgb");
  color(c, look.diffuse_rgb, "diffuse_rgb");
  color(c, look.specular_rgb, "specular_rgb");
  color(c, look.emissive_rgb, "emissive_rgb");
  text(c, look.texture, "texture");
  positive(c, look.texture_repeat_x, "texture_repeat_x");
  positive(c, look.texture_repeat_y, "texture_repeat_y");
  share(c, look.alpha, "alpha");
}

void check(Checker& c, const Open& open) {
  c.in("Open.");
  const std::size_t bodies = open.uavs.size() + open.bodies.size();
  name(c, open.world_name, "world_name");
  text(c, open.world_file, "world_file");
  positive(c, open.gravity_m_s2, "gravity_m_s2");
  c.require(open.step > Duration(0) && open.step <= std::chrono::seconds(1), "step",
            "is not within 1 ns..1 s");
  c.require(bodies <= kMaxBodies, "uavs, bodies",
            "are more than " + std::to_string(kMaxBodies) + " together");
  c.require(open.past_steps * bodies <= kMaxPastPoses, "past_steps",
            "makes more than " + std::to_string(kMaxPastPoses) + " past poses");
  size(c, open.max_width_px, open.max_height_px, 0);
  c.require(open.materials.size() <= kMaxMaterials, "looks",
            "are more than " + std::to_string(kMaxMaterials));
  for (const BodyName& body : open.bodies) {
    name(c, body.model, "bodies");
    name(c, body.link, "bodies");
  }
  for (const UavDescription& uav : open.uavs) check(c, uav);
  for (const VisualMaterial& material : open.materials) check(c, material);
}

// --- the other requests -------------------------------------------------------------------------

void check(Checker&, const Reset&) {}
void check(Checker& c, const Advance& advance) {
  c.in("Advance.");
  c.timestamp(advance.to, "to");
  c.require(advance.commands.size() <= kMaxBodies, "commands", "are too many");
  for (const Command& command : advance.commands) {
    c.require(command.uav < kMaxBodies, "commands", "have an unknown UAV index");
    c.require(is_valid(command.command), "commands", "are not valid velocity commands");
  }
}
void check(Checker& c, const CastRays& cast) {
  c.in("CastRays.");
  check(c, cast.X_WB, "X_WB");
  check(c, cast.X_WS, "X_WS");
  body(c, cast.carrier, cast.X_WB.size(), "carrier");
  c.require(!cast.rays_S.empty() && cast.rays_S.size() <= kMaxRays, "rays_S",
            "are not 1 to " + std::to_string(kMaxRays));
  for (const uav::Vec3& ray : cast.rays_S) unit(c, dot(ray, ray), "rays_S");
  positive(c, cast.max_m, "max_m");
}
void check(Checker& c, const Render& render) {
  c.in("Render.");
  const uav::CameraModel& camera = render.camera;
  size(c, camera.width_px, camera.height_px, 1);
  positive(c, camera.fx_px, "camera.fx_px");
  c.require(camera.fy_px == camera.fx_px && !camera.has_distortion(), "camera",
            "is not an ideal camera with square pixels");
  c.finite(camera.cx_px, "camera.cx_px");
  c.finite(camera.cy_px, "camera.cy_px");
  positive(c, render.near_m, "near_m");
  c.require(std::isfinite(render.far_m) && render.far_m > render.near_m, "far_m",
            "is not beyond near_m");
  check(c, render.X_WS, "X_WS");
  check(c, render.X_WB, "X_WB");
  body(c, render.hidden, render.X_WB.size(), "hidden");
}

// --- replies ------------------------------------------------------------------------------------

void check(Checker& c, const State& state) {
  c.in("State.");
  c.timestamp(state.now, "now");
  c.require(state.bodies.size() <= kMaxBodies, "bodies", "are too many");
  for (const uav::BodyState& body : state.bodies) {
    check(c, uav::Pose{body.p_WB, body.q_WB}, "bodies");
    c.finite(body.v_WB, "bodies");
    c.finite(body.w_WB_B, "bodies");
  }
  c.require(state.motions.size() <= state.bodies.size(), "motions", "are more than the bodies");
  for (const Motion& motion : state.motions) {
    c.finite(motion.a_WB_W, "motions");
    c.finite(motion.alpha_WB_B, "motions");
  }
  c.require(state.past.size() <= kMaxPastPoses, "past", "has too many poses");
  for (const uav::Pose& X : state.past) check(c, X, "past");
  c.require(state.touches.size() <= kMaxTouches, "touches", "are too many");
  for (const Touch& touch : state.touches) {
    c.timestamp(touch.at, "touches");
    name(c, touch.with, "touches");
    c.require(!touch.with.empty(), "touches", "have no name");
    c.require(std::isfinite(touch.speed_m_s), "touches", "have a speed that is not a number");
  }
}
void check(Checker& c, const Opened& opened) {
  c.in("Opened.");
  text(c, opened.description, "description");
  check(c, opened.state);
}
void check(Checker& c, const Distances& distances) {
  c.in("Distances.");
  c.require(distances.distance_m.size() <= kMaxRays, "distance_m", "has too many rays");
  // False for NaN.
  for (const double m : distances.distance_m)
    c.require(m >= 0.0, "distance_m", "is not a distance");
}
void check(Checker& c, const Picture& picture) {
  c.in("Picture.");
  size(c, picture.width_px, picture.height_px, 1);
  c.require(std::int64_t{picture.width_px} * picture.height_px * 3 ==
                static_cast<std::int64_t>(picture.rgb.size()),
            "rgb", "is not of width_px x height_px x 3 bytes");
  not_negative(c, picture.nearest_depth_m, "nearest_depth_m");
  text(c, picture.renderer, "renderer");
}
void check(Checker& c, const Failed& failed) {
  c.in("Failed.");
  text(c, failed.message, "message");
}

template <class Message>
Status validate_any(const Message& message) {
  Checker c;
  std::visit([&c](const auto& m) { check(c, m); }, message);
  return c.status();
}

}  // namespace

Status validate(const Request& request) {
  return validate_any(request);
}
Status validate(const Reply& reply) {
  return validate_any(reply);
}

}  // namespace tether::sim::protocol
