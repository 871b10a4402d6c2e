#include "convert/sdf_convert.h"

#include <algorithm>
#include <set>
#include <utility>

namespace tether::sim {

namespace {

/// Of the airframe's mass: a part that is lighter does not change how it flies.
constexpr double kLightPart = 0.01;

/// The first link, or the one named base_link.
const sdf::Link& find_body_link(const SdfSource& source, const sdf::Model& model) {
  if (const sdf::Link* base = model.LinkByName("base_link")) return *base;
  if (model.LinkCount() == 0) refuse(source, model.Element(), "has no link");
  return *model.LinkByIndex(0);
}

void warn_of_moving_joints(const SdfSource& source, const sdf::Model& model, const Uav& uav,
                           const WarningSink& warn) {
  for (std::uint64_t i = 0; i < model.JointCount(); ++i) {
    const sdf::Joint& joint = *model.JointByIndex(i);
    if (joint.Type() == sdf::JointType::FIXED ||
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

void add_sensors(const SdfSource& source, const sdf::Link& link, const uav::Pose& X_BL,
                 std::size_t joints, const WarningSink& warn, Uav& uav) {
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
    uav.sensors.push_back(std::move(*sensor));
  }
}

/// Visuals, collisions and sensors of a link that hangs on the body, behind so many joints; drawn
/// as if these were at 0. Its mass is not added: the body's inertia is that of the whole airframe.
void merge_link(const SdfSource& source, const sdf::Link& part, const uav::Pose& X_BM,
                std::size_t joints, const WarningSink& warn, Uav& uav) {
  Link link = read_link(source, part, warn);
  const uav::Pose X_BL = X_BM * link.X_ML;
  for (Visual& visual : link.visuals) {
    visual.name = link.name + "::" + visual.name;
    visual.X_LV = X_BL * visual.X_LV;
    uav.body.visuals.push_back(std::move(visual));
  }
  for (Collision& collision : link.collisions) {
    collision.name = link.name + "::" + collision.name;
    collision.X_LC = X_BL * collision.X_LC;
    uav.body.collisions.push_back(std::move(collision));
  }
  add_sensors(source, part, X_BL, joints, warn, uav);
  // The airframe's mass is that of all links: only a payload that the body does not include flies
  // differently. A link without a mass has SDF's, which nobody weighed.
  const sdf::ElementPtr inertial = part.Element()->FindElement("inertial");
  if (!inertial) return;
  const bool is_heavy =
      inertial->HasElement("mass") && link.mass_kg > kLightPart * uav.airframe.mass_kg;
  warn_at(source, part.Element(), Effect(Consequence::kBehavesDifferent, is_heavy),
          "is merged into link '" + uav.body.name + "'; its mass is not added", warn);
}

void add_links(const SdfSource& source, const sdf::Model& model, const sdf::Link& body,
               const WarningSink& warn, Uav& uav) {
  const uav::Pose X_BM = uav::inverse(uav.body.X_ML);
  Joints joints = read_joints(source, model, body.Name(), X_BM);
  uav.joints = std::move(joints.chain);
  for (std::uint64_t i = 0; i < model.LinkCount(); ++i) {
    const sdf::Link& link = *model.LinkByIndex(i);
    if (link.Name() == body.Name()) continue;
    if (const auto behind = joints.behind.find(link.Name()); behind != joints.behind.end()) {
      merge_link(source, link, X_BM, behind->second, warn, uav);
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
  const sdf::Link& body = find_body_link(source, *model);

  Uav uav;
  uav.body = read_link(source, body, warn);
  uav.airframe = read_airframe(source, model->Element(), uav.body, gravity_m_s2);
  uav.battery = read_battery(source, model->Element());
  add_sensors(source, body, {}, 0, warn, uav);
  add_links(source, *model, body, warn, uav);
  add_odometry(source, model->Element(), uav);
  warn_of_moving_joints(source, *model, uav, warn);
  check_sensor_names(source, model->Element(), uav);
  return uav;
}

}  // namespace tether::sim
