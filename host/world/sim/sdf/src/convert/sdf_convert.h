#pragma once

#include "checks/sdf_check.h"
#include "files/sdf_source.h"

#include <initializer_list>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <ignition/math/Color.hh>
#include <ignition/math/Pose3.hh>

#include <tether/sim/world.h>

/// From libsdformat's objects to ours, one part each. Values have been checked before
/// (`check_elements`); errors found here involve more than one element.
namespace tether::sim {

uav::Vec3 to_vec3(const ignition::math::Vector3d& v);
uav::Vec3 to_vec3(const ignition::math::Color& color);
uav::Pose to_pose(const ignition::math::Pose3d& pose);

/// Pose of an SDF object in the frame that it is given in by default (SDF's frame semantics): a
/// model or light in its world, a link in its model, a visual, collision or sensor in its link.
template <class SdfObject>
uav::Pose resolved_pose(const SdfSource& source, const SdfObject& object) {
  ignition::math::Pose3d pose;
  const sdf::Errors errors = object.SemanticPose().Resolve(pose);
  if (!errors.empty()) {
    const std::string& frame = object.PoseRelativeTo();
    refuse(source, object.Element(),
           frame.empty() ? "has a pose that cannot be resolved"
                         : "has a pose relative to '" + frame +
                               "', which cannot be found. Name a link, joint, model or frame of "
                               "the same model");
  }
  return to_pose(pose);
}

/// The element that a path of names leads to; nullptr if there is none.
sdf::ElementPtr find_path(sdf::ElementPtr element, std::initializer_list<const char*> names);
/// ".dae" of "a.DAE".
std::string extension_of(const std::filesystem::path& file);

/// The material of a visual, whose geometry `out` has: of its <material>, if there is one, of a
/// material script that this names, else of the file of its mesh.
void read_look(const SdfSource& source, const sdf::Material* material, const WarningSink& warn,
               Visual& out);

/// A cone, polylines or a heightmap of a <geometry>; none: it is another shape, or is left out.
std::optional<MeshGeometry> read_made_shape(const SdfSource& source,
                                            const sdf::ElementPtr& geometry,
                                            const WarningSink& warn);
/// The <pos> of a heightmap in a <geometry>.
uav::Pose offset_of_heightmap(const SdfSource& source, const sdf::ElementPtr& geometry);
/// A <heightmap> has its textures in itself.
void read_look_of_heightmap(const SdfSource& source, const sdf::ElementPtr& heightmap,
                            const WarningSink& warn, const MeshGeometry& mesh, Material& look);

/// A <road> of the world, which nothing touches; none, with a warning, if it is no strip.
std::optional<Model> read_road(const SdfSource& source, const sdf::ElementPtr& road,
                               const WarningSink& warn);

/// One link, with its visuals and collisions.
Link read_link(const SdfSource& source, const sdf::Link& link, const WarningSink& warn);

/// A light of the world or of a static link; X_WP is the pose of what it is given in.
Light read_light(const SdfSource& source, const sdf::Light& light, const uav::Pose& X_WP);

/// A sensor, none if Tether does not simulate its type; X_BL is the pose of its link.
std::optional<Sensor> read_sensor(const SdfSource& source, const sdf::Sensor& sensor,
                                  const uav::Pose& X_BL, const WarningSink& warn);

/// Adds the sensor of the joints, if there are any.
void add_joint_state(const SdfSource& source, const sdf::ElementPtr& model, Uav& uav);
/// Adds the sensor that the model's odometry plugin stands for, if it has one.
void add_odometry(const SdfSource& source, const sdf::ElementPtr& model, Uav& uav);

/// A link of a UAV's model, or of a model that is nested in it.
struct Part {
  const sdf::Link* link = nullptr;
  std::string name{};  ///< "iris::rotor_0"
  uav::Pose X_MN{};    ///< of the model that has the link, in the outermost one
};

/// Whether plugins of the model, or of one nested in it, say how its rotors turn and push.
bool has_motor_plugins(const sdf::Model& model);
/// What these plugins said of an airframe.
struct Motors {
  std::set<std::string> joints{};  ///< that turn rotors
  std::set<std::string> given{};   ///< numbers, by their names in <tether:multirotor>
};
/// Reads them into an airframe.
/// @throws Error(kBadFile) if a rotor does not push up, or they differ, or a number is missing.
Motors read_motors(const SdfSource& source, const sdf::Model& model, const std::vector<Part>& parts,
                   const uav::Pose& X_BM, uav::MultirotorParameters& airframe);

/// Airframe of a UAV, with mass and inertia of the body: of <tether:multirotor>, else of the
/// plugins of its motors. Says in `uav` where it is from.
/// @return joints that turn rotors.
std::set<std::string> read_airframe(const SdfSource& source, const sdf::Model& model,
                                    const std::vector<Part>& parts, double gravity_m_s2, Uav& uav);

/// The battery of a UAV by a battery plugin of its model; none if it has none.
std::optional<energy::Battery> read_battery(const SdfSource& source, const sdf::ElementPtr& model);

/// The joints of a UAV that its program can turn, a chain from the body outwards, and behind how
/// many of them each link is that hangs on the body. Those of rotors are not among them.
struct Joints {
  std::vector<uav::Joint> chain;
  std::map<std::string, std::size_t> behind;
};
Joints read_joints(const SdfSource& source, const sdf::Model& model, const std::string& body,
                   const uav::Pose& X_BM, const std::set<std::string>& of_rotors);

uav::Pose start_pose(const UavPlacement& placement);
/// The UAV of a model file, without a name or place.
Uav read_uav(const SdfSource& source, double gravity_m_s2, const WarningSink& warn);

/// The model or UAV `name` of the world as an anchor.
/// @throws Error(kBadFile) about `name`: not a model, or not one untextured box, cylinder or
/// sphere.
PlacedAnchor find_anchor(const SdfSource& source, const World& world, const std::string& name,
                         const FileLocation& requested_at);

}  // namespace tether::sim
