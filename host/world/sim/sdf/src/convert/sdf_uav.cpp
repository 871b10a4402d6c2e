#include "convert/sdf_convert.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace tether::sim {

namespace {

/// Of the airframe's mass: a part that is lighter does not change how it flies.
constexpr double kLightPart = 0.01;

/// Of products of inertia to moments: what is less does not change how it flies.
constexpr double kSkew = 0.05;

/// The links of a model, and then those of the models that are nested in it.
void add_parts(const SdfSource& source, const sdf::Model& model, const std::string& scope,
               const uav::Pose& X_MN, std::vector<Part>& parts) {
  for (std::uint64_t i = 0; i < model.LinkCount(); ++i) {
    const sdf::Link* const link = model.LinkByIndex(i);
    parts.push_back({link, scope + link->Name(), X_MN});
  }
  for (std::uint64_t i = 0; i < model.ModelCount(); ++i) {
    const sdf::Model& nested = *model.ModelByIndex(i);
    add_parts(source, nested, scope + nested.Name() + "::", X_MN * resolved_pose(source, nested),
              parts);
  }
}

/// "lidar" of the link "vehicle::lidar::link"; empty: of the outermost model.
std::string nested_in(const Part& part) {
  const std::size_t end = part.name.size() - part.link->Name().size();
  if (end < 2) return "";
  const std::string scope = part.name.substr(0, end - 2);
  const std::size_t before = scope.rfind("::");
  return before == std::string::npos ? scope : scope.substr(before + 2);
}

/// The first link, or the one named base_link.
const Part& find_body(const SdfSource& source, const sdf::Model& model,
                      const std::vector<Part>& parts) {
  if (parts.empty()) refuse(source, model.Element(), "has no link");
  const auto base = std::ranges::find_if(
      parts, [](const Part& part) { return part.link->Name() == "base_link"; });
  return base == parts.end() ? parts.front() : *base;
}

ignition::math::Pose3d to_library(const uav::Pose& pose) {
  return {pose.p.x, pose.p.y, pose.p.z, pose.q.w, pose.q.x, pose.q.y, pose.q.z};
}

/// Makes one rigid body of all parts: it has the mass of all, and its frame is at their centre of
/// mass, with the axes of the body's link.
void weld(const SdfSource& source, const sdf::Model& model, const std::vector<Part>& parts,
          const WarningSink& warn, Link& body) {
  const uav::Pose X_BM = uav::inverse(body.X_ML);
  std::optional<ignition::math::Inertiald> all;
  for (const Part& part : parts) {
    if (!part.link->Element()->HasElement("inertial")) continue;  // SDF's 1 kg, that nobody weighed
    const auto& own = part.link->Inertial();
    const uav::Pose X_BL = X_BM * part.X_MN * resolved_pose(source, *part.link);
    const ignition::math::Inertiald placed(own.MassMatrix(),
                                           to_library(X_BL * to_pose(own.Pose())));
    all = all ? *all + placed : placed;
  }
  if (!all) refuse(source, model.Element(), "has no link with an <inertial>");
  const auto moment = all->Moi();
  const double skew =
      std::max({std::abs(moment(0, 1)), std::abs(moment(0, 2)), std::abs(moment(1, 2))});
  if (skew > kSkew * std::min({moment(0, 0), moment(1, 1), moment(2, 2)}))
    warn_at(source, model.Element(), Effect(Consequence::kBehavesDifferent, false),
            "has products of inertia, which are left out", warn);
  const uav::Pose X_LB{to_vec3(all->Pose().Pos()), {}};
  const uav::Pose X_BL = uav::inverse(X_LB);
  body.mass_kg = all->MassMatrix().Mass();
  body.inertia_kg_m2 = {moment(0, 0), moment(1, 1), moment(2, 2)};
  body.X_LI = {};
  body.X_ML = body.X_ML * X_LB;
  for (Visual& visual : body.visuals) visual.X_LV = X_BL * visual.X_LV;
  for (Collision& collision : body.collisions) collision.X_LC = X_BL * collision.X_LC;
}

void warn_of_moving_joints(const SdfSource& source, const sdf::Model& model, const Uav& uav,
                           const std::set<std::string>& of_rotors, const WarningSink& warn) {
  for (std::uint64_t i = 0; i < model.JointCount(); ++i) {
    const sdf::Joint& joint = *model.JointByIndex(i);
    if (joint.Type() == sdf::JointType::FIXED || of_rotors.contains(joint.Name()) ||
        std::ranges::find(uav.joints, joint.Name(), &uav::Joint::name) != uav.joints.end())
      continue;
    // What its link does to the flight, the warning of the link says.
    warn_at(source, joint.Element(), Effect(Consequence::kBehavesDifferent, false),
            "is a moving joint, which is not represented; ignored. Those that programs can command "
            "are revolute, in one chain from the body, and have a <limit> with <lower>, <upper> "
            "and <velocity>",
            warn);
  }
}

/// What measures motion is not simulated behind a joint.
bool can_be_turned(uav::SensorKind kind) {
  return kind == uav::SensorKind::kCamera || kind == uav::SensorKind::kRange ||
         kind == uav::SensorKind::kScan;
}

/// A sensor of a nested model whose name is taken gets that of its model before it.
void make_distinct(const SdfSource& source, const sdf::ElementPtr& element,
                   const std::string& scope, const WarningSink& warn, const Uav& uav,
                   Sensor& sensor) {
  const auto is_taken = [&] {
    return std::ranges::find(uav.sensors, sensor.name, &Sensor::name) != uav.sensors.end();
  };
  if (scope.empty() || !is_taken()) return;
  sensor.name = scope + "_" + sensor.name;
  warn_at(source, element, Consequence::kBehavesDifferent,
          "has the name of another sensor; its name is '" + sensor.name + "'", warn);
}

/// @param scope of the link's model, if that is nested
void add_sensors(const SdfSource& source, const sdf::Link& link, const uav::Pose& X_BL,
                 std::size_t joints, const std::string& scope, const WarningSink& warn, Uav& uav) {
  for (std::uint64_t i = 0; i < link.SensorCount(); ++i) {
    auto sensor = read_sensor(source, *link.SensorByIndex(i), X_BL, warn);
    if (!sensor) continue;
    if (joints > 0 && !can_be_turned(sensor->kind())) {
      warn_at(source, link.SensorByIndex(i)->Element(), Consequence::kMissing,
              "is behind a moving joint, where only cameras, rangefinders and lidars are "
              "simulated; left out",
              warn);
      continue;
    }
    sensor->joints = joints;
    make_distinct(source, link.SensorByIndex(i)->Element(), scope, warn, uav, *sensor);
    uav.sensors.push_back(std::move(*sensor));
  }
}

/// What a part behind joints weighs joins the body, as if the part were held at 0. It is balanced:
/// the centre of mass stays where it is.
void add_mass(const Link& part, const uav::Pose& X_BL, Uav& uav) {
  const uav::Pose X_BI = X_BL * part.X_LI;
  const uav::Vec3 own = part.inertia_kg_m2;
  const double m = part.mass_kg;
  const double axes[] = {own.x, own.y, own.z};
  const uav::Vec3 columns[] = {rotate(X_BI.q, {1, 0, 0}), rotate(X_BI.q, {0, 1, 0}),
                               rotate(X_BI.q, {0, 0, 1})};
  const double squared_m2 = dot(X_BI.p, X_BI.p);
  uav::Vec3 inertia = uav.airframe.inertia_kg_m2;
  for (double uav::Vec3::*axis : {&uav::Vec3::x, &uav::Vec3::y, &uav::Vec3::z}) {
    inertia.*axis += m * (squared_m2 - X_BI.p.*axis * X_BI.p.*axis);
    for (std::size_t i = 0; i < 3; ++i)
      inertia.*axis += axes[i] * columns[i].*axis * columns[i].*axis;
  }
  uav.airframe.mass_kg += m;
  uav.airframe.inertia_kg_m2 = inertia;
  uav.body.mass_kg = uav.airframe.mass_kg;
  uav.body.inertia_kg_m2 = inertia;
}

/// Visuals, collisions and sensors of a link that hangs on the body, behind so many joints; it
/// collides as if these were at 0.
/// @param is_weighed the body's mass contains it; else the body's inertia is, as it is written,
/// that of the whole airframe
/// @param scope of the link's model, if that is nested
void merge_link(const SdfSource& source, const sdf::Link& part, const uav::Pose& X_BM,
                std::size_t joints, bool is_weighed, const WarningSink& warn, Uav& uav,
                const std::string& scope = "") {
  Link link = read_link(source, part, warn);
  const uav::Pose X_BL = X_BM * link.X_ML;
  for (Visual& visual : link.visuals) {
    visual.name = link.name + "::" + visual.name;
    visual.X_LV = X_BL * visual.X_LV;
    visual.joints = joints;
    uav.body.visuals.push_back(std::move(visual));
  }
  for (Collision& collision : link.collisions) {
    collision.name = link.name + "::" + collision.name;
    collision.X_LC = X_BL * collision.X_LC;
    uav.body.collisions.push_back(std::move(collision));
  }
  add_sensors(source, part, X_BL, joints, scope, warn, uav);
  // The body's mass is that of all that is fixed to it: only a payload that it does not include
  // flies differently. A link without a mass has SDF's, which nobody weighed.
  const sdf::ElementPtr inertial = part.Element()->FindElement("inertial");
  if (!inertial || is_weighed) return;
  if (joints > 0) return add_mass(link, X_BL, uav);
  const bool is_heavy =
      inertial->HasElement("mass") && link.mass_kg > kLightPart * uav.airframe.mass_kg;
  warn_at(source, part.Element(), Effect(Consequence::kBehavesDifferent, is_heavy),
          "is merged into link '" + uav.body.name + "'; its mass is not added", warn);
}

void add_links(const SdfSource& source, const sdf::Model& model, const sdf::Link& body,
               const WarningSink& warn, Uav& uav) {
  const uav::Pose X_BM = uav::inverse(uav.body.X_ML);
  Joints joints = read_joints(source, model, body.Name(), X_BM, {});
  uav.joints = std::move(joints.chain);
  for (std::uint64_t i = 0; i < model.LinkCount(); ++i) {
    const sdf::Link& link = *model.LinkByIndex(i);
    if (link.Name() == body.Name()) continue;
    if (const auto behind = joints.behind.find(link.Name()); behind != joints.behind.end()) {
      merge_link(source, link, X_BM, behind->second, false, warn, uav);
    } else {
      const bool acts = link.SensorCount() > 0 || link.CollisionCount() > 0;
      warn_at(source, link.Element(), Effect(Consequence::kMissing, acts),
              "is not connected to link '" + body.Name() + "'; left out", warn);
    }
  }
}

void check_sensor_names(const SdfSource& source, const sdf::ElementPtr& model, const Uav& uav) {
  std::set<std::string> names;
  for (const Sensor& sensor : uav.sensors) {
    if (!names.insert(sensor.name).second) {
      refuse(source, model, "has two sensors of the name '" + sensor.name + "'; names must differ");
    }
  }
}

}  // namespace

uav::Pose start_pose(const UavPlacement& placement) {
  return {placement.p_WB, uav::from_rpy(0.0, 0.0, placement.yaw_rad)};
}

Uav read_uav(const SdfSource& source, double gravity_m_s2, const WarningSink& warn) {
  const sdf::Model* model = source.root().Model();
  if (model == nullptr) {
    throw Error(ErrorCode::kBadFile, {source.file().string(), 0},
                "has no <model>; a UAV's file must have exactly one")
        .about("<model>");
  }
  std::vector<Part> parts;
  add_parts(source, *model, "", {}, parts);
  const Part& body = find_body(source, *model, parts);
  // Who writes <tether:multirotor> says what the whole weighs; else each link weighs its own.
  const bool is_welded = !model->Element()->HasElement("tether:multirotor");

  Uav uav;
  uav.body = read_link(source, *body.link, warn);
  uav.body.X_ML = body.X_MN * uav.body.X_ML;
  const uav::Pose X_ML = uav.body.X_ML;
  if (is_welded) weld(source, *model, parts, warn, uav.body);
  const std::set<std::string> of_rotors = read_airframe(source, *model, parts, gravity_m_s2, uav);
  uav.battery = read_battery(source, model->Element());
  const uav::Pose X_BM = uav::inverse(uav.body.X_ML);
  add_sensors(source, *body.link, X_BM * X_ML, 0, "", warn, uav);
  if (is_welded) {
    Joints joints = read_joints(source, *model, body.name, X_BM, of_rotors);
    uav.joints = std::move(joints.chain);
    for (const Part& part : parts)
      if (part.link != body.link)
        merge_link(source, *part.link, X_BM * part.X_MN, joints.behind[part.name], true, warn, uav,
                   nested_in(part));
  } else {
    add_links(source, *model, *body.link, warn, uav);
  }
  add_odometry(source, model->Element(), uav);
  add_joint_state(source, model->Element(), uav);
  warn_of_moving_joints(source, *model, uav, of_rotors, warn);
  check_sensor_names(source, model->Element(), uav);
  return uav;
}

}  // namespace tether::sim
