#include "sdf_text.h"

#include "sdf16_shapes.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <string_view>
#include <system_error>
#include <variant>

#include <tether/base/error.h>

namespace tether::sim {
namespace {

// --- text ---------------------------------------------------------------------------------------

/// As many digits as it takes to read the same number again.
std::string text(double value) {
  std::array<char, 32> digits{};
  const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc{}) throw Error(ErrorCode::kInternal, "a number in SDF is too long");
  return {digits.data(), end};
}
std::string text(const uav::Vec3& v) {
  return text(v.x) + " " + text(v.y) + " " + text(v.z);
}
std::string text(const uav::Pose& X) {
  return text(X.p) + " " + text(to_rpy_rad(X.q));
}

std::string escaped(const std::string& raw) {
  constexpr std::string_view kSpecial = "&<>'";
  constexpr std::array<const char*, 4> kEntities{"&amp;", "&lt;", "&gt;", "&apos;"};
  std::string out;
  for (const char c : raw) {
    const std::size_t at = kSpecial.find(c);
    out += at == std::string_view::npos ? std::string(1, c) : kEntities[at];
  }
  return out;
}

std::string element(const std::string& name, const std::string& content) {
  return "<" + name + ">" + content + "</" + name + ">";
}
std::string named(const std::string& element, const std::string& name, const std::string& content) {
  return "<" + element + " name='" + escaped(name) + "'>" + content + "</" + element + ">\n";
}

// --- geometries ---------------------------------------------------------------------------------

std::string sdf(const BoxGeometry& g) {
  return element("box", element("size", text(g.size_m)));
}
std::string sdf(const CylinderGeometry& g) {
  return element("cylinder",
                 element("radius", text(g.radius_m)) + element("length", text(g.length_m)));
}
std::string sdf(const SphereGeometry& g) {
  return element("sphere", element("radius", text(g.radius_m)));
}
std::string sdf(const PlaneGeometry& g) {
  return element("plane", element("normal", text(g.normal)) +
                              element("size", text(g.size_x_m) + " " + text(g.size_y_m)));
}
std::string sdf(const MeshGeometry& g) {
  const std::string centered = g.is_centered ? element("center", "true") : "";
  const std::string part =
      g.submesh.empty() ? "" : element("submesh", element("name", escaped(g.submesh)) + centered);
  return element("mesh", element("uri", "file://" + escaped(g.file.string())) + part +
                             element("scale", text(g.scale)));
}
template <class Later>
std::string sdf(const Later&) {
  throw Error(ErrorCode::kInternal, "a shape that SDF 1.6 does not have");
}

std::string sdf_geometry(const Geometry& geometry) {
  return element("geometry", std::visit([](const auto& g) { return sdf(g); }, geometry));
}

// --- the link -----------------------------------------------------------------------------------

std::string color(const std::string& name, const uav::Vec3& rgb) {
  return element(name, text(rgb) + " 1");
}

std::string sdf(const Visual& visual) {
  const Material& m = visual.material;
  const std::string material = element(
      "material", color("ambient", m.ambient_rgb) + color("diffuse", m.diffuse_rgb) +
                      color("specular", m.specular_rgb) + color("emissive", m.emissive_rgb));
  return named("visual", visual.name,
               element("pose", text(visual.X_LV)) +
                   element("cast_shadows", visual.cast_shadows ? "1" : "0") +
                   element("transparency", text(1.0 - m.alpha)) + sdf_geometry(visual.geometry) +
                   (visual.has_look_of_mesh ? "" : material));
}

std::string sdf(const Collision& collision) {
  const std::string mu = text(collision.friction);
  const std::string mask = element("collide_bitmask", std::to_string(collision.bits));
  const std::string contact = collision.bits == Collision{}.bits ? "" : element("contact", mask);
  return named("collision", collision.name,
               element("pose", text(collision.X_LC)) + sdf_geometry(collision.geometry) +
                   element("surface",
                           contact + element("friction", element("ode", element("mu", mu) +
                                                                            element("mu2", mu)))));
}

/// The centre of mass lies in B's origin: load_world requires it.
std::string sdf_inertial(const uav::MultirotorParameters& airframe) {
  const uav::Vec3& i = airframe.inertia_kg_m2;
  return element("inertial",
                 element("mass", text(airframe.mass_kg)) +
                     element("inertia", element("ixx", text(i.x)) + element("ixy", "0") +
                                            element("ixz", "0") + element("iyy", text(i.y)) +
                                            element("iyz", "0") + element("izz", text(i.z))));
}

}  // namespace

uav::Vec3 to_rpy_rad(const uav::Quat& q) {
  const double sin_pitch = 2.0 * (q.w * q.y - q.z * q.x);
  // Straight up or down, only the sum or difference of roll and yaw matters: all of it is roll.
  if (std::abs(sin_pitch) > 1.0 - 1e-12) {
    return {2.0 * std::atan2(q.x, q.w), std::copysign(std::numbers::pi / 2.0, sin_pitch), 0.0};
  }
  return {std::atan2(2.0 * (q.w * q.x + q.y * q.z), 1.0 - 2.0 * (q.x * q.x + q.y * q.y)),
          std::asin(sin_pitch),
          std::atan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y * q.y + q.z * q.z))};
}

std::string to_sdf(const Uav& uav, const WarningSink& warn) {
  std::string shapes;
  for (const Visual& visual : sdf16_visuals(uav, warn)) shapes += sdf(visual);
  for (const Collision& collision : sdf16_collisions(uav, warn)) shapes += sdf(collision);
  const std::string link =
      named("link", "base_link", sdf_inertial(uav.airframe) + "\n" + std::move(shapes));
  return "<?xml version='1.0'?>\n<sdf version='1.6'>\n" +
         named("model", uav.name, element("pose", text(uav.X_WB)) + "\n" + link) + "</sdf>\n";
}

}  // namespace tether::sim
