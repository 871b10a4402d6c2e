#include "physics_model.h"

#include "heightmap.h"
#include "meshes/named_file.h"
#include "meshes/triangle_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <tether/base/error.h>
#include <tether/sim/world.h>

namespace tether::sim {
namespace {

using uav::Pose;
using uav::Vec3;

// The engine has a static heightmap as a whole.
bool is_left_to_another(const Collision& collision) {
  return is_heightmap(collision.geometry) &&
         std::get<MeshGeometry>(collision.geometry).piece.value_or(0) > 0;
}

// MuJoCo's MJCF, written piece by piece. Numbers are written so that they read back exactly.
class PhysicsXml {
 public:
  PhysicsXml(const MeshFiles& meshes, const WarningSink& warn) : mesh_files_(meshes), warn_(warn) {}

  // The shapes of a link, at `X` in the engine's body: W for a static link, its own frame for a
  // moving one. What may not be pushed meets what may.
  void add_collisions(const Link& link, const Pose& X, bool is_static, bool may_be_pushed) {
    for (const Collision& collision : link.collisions) {
      if (is_static && is_left_to_another(collision)) continue;
      const std::string shape = describe(collision, X * collision.X_LC, is_static);
      if (shape.empty()) continue;
      append(R"(<geom {} contype="{}" conaffinity="{}" friction="{} 0.005 0.0001"/>)", shape,
             may_be_pushed ? collision.bits : 0, collision.bits,
             std::min(collision.friction, kMostFriction));
    }
  }

  void add_moving(const MovingBody& body) {
    append("<body {}><freejoint/>", place(body.X_WB));
    const Link& link = *body.link;
    if (body.uav) {
      const uav::MultirotorParameters& frame = body.uav->airframe;
      add_inertia({link.X_LI.p, {}}, frame.mass_kg, frame.inertia_kg_m2);
    } else if (body.model->path) {
      add_inertia({}, kDrivenMass_kg, {kDrivenMass_kg, kDrivenMass_kg, kDrivenMass_kg});
    } else {
      add_inertia(link.X_LI, link.mass_kg, link.inertia_kg_m2);
    }
    add_collisions(link, {}, false, body.uav || !body.model->path);
    body_ += "</body>";
  }

  std::string text(const World& world) const {
    return fmt::format(R"(<mujoco><compiler angle="radian" inertiafromgeom="false"/>)"
                       R"(<option timestep="{}" gravity="{} {} {}" integrator="Euler">)"
                       R"(<flag equality="disable" limit="disable" passive="disable"/></option>)"
                       R"(<size nconmax="{}" njmax="{}"/>)"
                       "<asset>{}</asset><worldbody>{}</worldbody></mujoco>",
                       to_seconds(world.step), world.gravity_x_m_s2, world.gravity_y_m_s2,
                       -world.gravity_m_s2, kMaxContacts, 4 * kMaxContacts, assets_, body_);
  }

  // The engine's text has no room for them.
  void fill_heights(mjModel& model) const {
    for (std::size_t i = 0; i < heights_.size(); ++i)
      std::ranges::copy(heights_[i].shares, model.hfield_data + model.hfield_adr[i]);
  }

 private:
  static constexpr int kMaxContacts = 500;
  /// On a slope of 70° nothing slides. Of larger ones, the engine's contacts get soft: at 20, a UAV
  /// sinks through the floor.
  static constexpr double kMostFriction = 3.0;

  template <class... Args>
  void append(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(body_), format, std::forward<Args>(args)...);
  }

  static std::string place(const Pose& X) {
    return fmt::format(R"(pos="{} {} {}" quat="{} {} {} {}")", X.p.x, X.p.y, X.p.z, X.q.w, X.q.x,
                       X.q.y, X.q.z);
  }

  void add_inertia(const Pose& X, double mass_kg, const Vec3& inertia) {
    append(R"(<inertial {} mass="{}" diaginertia="{} {} {}"/>)", place(X), mass_kg, inertia.x,
           inertia.y, inertia.z);
  }

  // The shape as attributes of a <geom>; empty: there is none.
  std::string describe(const Collision& collision, const Pose& X, bool is_static) {
    const auto shape = [&X](const char* type, const auto&... sizes) {
      const std::array<double, sizeof...(sizes)> list{sizes...};
      return fmt::format(R"(type="{}" {} size="{}")", type, place(X), fmt::join(list, " "));
    };
    return std::visit(
        Visitor{
            [&](const BoxGeometry& g) {
              return shape("box", 0.5 * g.size_m.x, 0.5 * g.size_m.y, 0.5 * g.size_m.z);
            },
            [&](const CylinderGeometry& g) {
              return shape("cylinder", g.radius_m, 0.5 * g.length_m);
            },
            [&](const SphereGeometry& g) { return shape("sphere", g.radius_m); },
            [&](const CapsuleGeometry& g) {
              return shape("capsule", g.radius_m, 0.5 * g.length_m);
            },
            [&](const EllipsoidGeometry& g) {
              return shape("ellipsoid", g.radii_m.x, g.radii_m.y, g.radii_m.z);
            },
            [&](const PlaneGeometry& g) { return describe(g, X, collision, is_static); },
            [&](const MeshGeometry& g) {
              return is_static && is_heightmap(g) ? describe_heights(g, X, collision)
                                                  : describe(g, X, collision);
            },
        },
        collision.geometry);
  }

  // The engine's planes are infinite, as SDF's collision planes are, and cannot move.
  std::string describe(const PlaneGeometry& plane, const Pose& X, const Collision& collision,
                       bool is_static) const {
    if (!is_static) {
      warn_({Consequence::kBehavesDifferent,
             {},
             fmt::format("collision '{}'", collision.name),
             "is a plane of a moving body, which does not collide"});
      return {};
    }
    const Pose X_P{X.p, X.q * rotation_from_z(plane.normal)};
    return fmt::format(R"(type="plane" {} size="0 0 1")", place(X_P));
  }

  std::string describe(const MeshGeometry& mesh, const Pose& X, const Collision& collision) {
    if (mesh.piece.value_or(0) == 0) warn_of_shape(mesh, collision);
    const auto [known, is_new] = meshes_.try_emplace(key_of(mesh), meshes_.size());
    const std::string name = fmt::format("m{}", known->second);
    if (is_new) {
      std::string vertices;
      for (const Vec3& v : read_named(mesh.named_at, [&] { return mesh_files_.corners(mesh); })) {
        fmt::format_to(std::back_inserter(vertices), "{} {} {} ", v.x, v.y, v.z);
      }
      assets_ += fmt::format(R"(<mesh name="{}" vertex="{}"/>)", name, vertices);
    }
    return fmt::format(R"(type="mesh" {} mesh="{}")", place(X), name);
  }

  std::string describe_heights(const MeshGeometry& mesh, const Pose& X,
                               const Collision& collision) {
    constexpr double kDepth_m = 10.0;  // below height 0: what is in it is pushed up
    warn_of_shape(mesh, collision, "has the clearances of");
    MeshGeometry whole = mesh;
    whole.piece.reset();
    const Heights& heights = heights_.emplace_back(
        heights_of(read_named(mesh.named_at, [&] { return mesh_files_.load(whole, {}); })));
    const std::string name = fmt::format("h{}", heights_.size());
    assets_ += fmt::format(R"(<hfield name="{}" nrow="{}" ncol="{}" size="{} {} {} {}"/>)", name,
                           heights.rows, heights.columns, heights.half_x_m, heights.half_y_m,
                           heights.top_m, kDepth_m);
    return fmt::format(R"(type="hfield" {} hfield="{}")", place(X), name);
  }

  void warn_of_shape(const MeshGeometry& mesh, const Collision& collision,
                     std::string_view what = "collides as") const {
    constexpr double kAsWritten_m = 0.01;
    const CollisionPieces& pieces = read_named(
        mesh.named_at, [&]() -> const CollisionPieces& { return mesh_files_.pieces(mesh); });
    const bool is_hull = !mesh.piece && (pieces.tolerance_m == 0.0 || pieces.corners.size() > 1);
    if (!is_hull && pieces.tolerance_m <= kAsWritten_m) return;
    warn_({Consequence::kBehavesDifferent,
           {mesh.file.string()},
           fmt::format("collision '{}'", collision.name),
           is_hull ? fmt::format("{} the convex hull of its mesh", what)
                   : fmt::format("{} convex pieces that are up to {:g} m beside its mesh", what,
                                 pieces.tolerance_m)});
  }

  const MeshFiles& mesh_files_;
  const WarningSink& warn_;
  std::string assets_;
  std::string body_;
  std::map<MeshKey, std::size_t> meshes_;
  std::vector<Heights> heights_;
};

}  // namespace

// The engine keeps the order of the shapes: those of its world, then body by body.
std::vector<Shape> shapes_of(const World& world) {
  std::vector<Shape> shapes;
  const auto add = [&shapes](const std::string& owner, const Collision& collision) {
    shapes.push_back({owner, static_cast<float>(collision.intensity)});
  };
  for (const FixedBody& body : fixed_bodies(world)) {
    for (const Collision& collision : body.link->collisions)
      if (!is_left_to_another(collision)) add(body.model->name, collision);
  }
  for (const MovingBody& body : moving_bodies(world)) {
    for (const Collision& collision : body.link->collisions) {
      if (std::holds_alternative<PlaneGeometry>(collision.geometry)) continue;
      add(body.uav ? body.uav->name : body.model->name, collision);
    }
  }
  return shapes;
}

ModelPtr make_physics_model(const World& world, const WarningSink& warn, const MeshFiles& meshes) {
  PhysicsXml xml(meshes, warn);
  for (const FixedBody& body : fixed_bodies(world)) {
    xml.add_collisions(*body.link, body.X_WB, true, false);
  }
  for (const MovingBody& body : moving_bodies(world)) xml.add_moving(body);
  ModelPtr model = compile_model(xml.text(world));
  xml.fill_heights(*model);
  return model;
}

}  // namespace tether::sim
