#include "convert/sdf_convert.h"

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

bool is_fixed_to(const sdf::Model& model, const std::string& link, const std::string& body) {
  for (std::uint64_t i = 0; i < model.JointCount(); ++i) {
    const sdf::Joint& joint = *model.JointByIndex(i);
    const bool joins = (joint.ParentLinkName() == body && joint.ChildLinkName() == link) ||
                       (joint.ParentLinkName() == link && joint.ChildLinkName() == body);
    if (joins && joint.Type() == sdf::JointType::FIXED) return true;
  }
  return false;
}

void warn_of_moving_joints(const SdfSource& source, const sdf::Model& model,
                           const WarningSink& warn) {
  for (std::uint64_t i = 0; i < model.JointCount(); ++i) {
    const sdf::Joint& joint = *model.JointByIndex(i);
    if (joint.Type() == sdf::JointType::FIXED) continue;
    // What its link does to the flight, the warning of the link says.
    warn_at(source, joint.Element(), Effect(Consequence::kBehavesDifferent, false),
            "is a moving joint, which is not represented; ignored", warn);
  }
}

void add_sensors(const SdfSource& source, const sdf::Link& link, const uav::Pose& X_BL,
                 const WarningSink& warn, Uav& uav) {
  for (std::uint64_t i = 0; i < link.SensorCount(); ++i) {
    auto sensor = read_sensor(source, *link.SensorByIndex(i), X_BL, warn);
    if (sensor) uav.sensors.push_back(std::move(*sensor));
  }
}

/// Visuals, collisions and sensors of a link that is fixed to the body. Its mass is not added: the
/// body's inertia is that of the whole airframe.
void merge_link(const SdfSource& source, const sdf::Link& part, const uav::Pose& X_BM,
                const WarningSink& warn, Uav& uav) {
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
  add_sensors(source, part, X_BL, warn, uav);
  // The airframe's mass is that of all links: only a payload that the body does not include flies
  // differently. A link without a mass has SDF's, which nobody weighed.
  const sdf::ElementPtr inertial = part.Element()->FindElement("inertial");
  if (!inertial) return;
  const bool is_heavy =
      inertial->HasElement("mass") && link.mass_kg > kLightPart * uav.airframe.mass_kg;
  warn_at(source, part.Element(), Effect(Consequence::kBehavesDifferent, is_heavy),
          "is merged into link '" + uav.body.name + "'; its mass is not added", warn);
}

void add_fixed_links(const SdfSource& source, const sdf::Model& model, const sdf::Link& body,
                     const WarningSink& warn, Uav& uav) {
  const uav::Pose X_BM = uav::inverse(uav.body.X_ML);
  for (std::uint64_t i = 0; i < model.LinkCount(); ++i) {
    const sdf::Link& link = *model.LinkByIndex(i);
    if (link.Name() == body.Name()) continue;
    if (is_fixed_to(model, link.Name(), body.Name())) {
      merge_link(source, link, X_BM, warn, uav);
    } else {
      const bool acts = link.SensorCount() > 0 || link.CollisionCount() > 0;
      warn_at(source, link.Element(), Effect(Consequence::kMissing, acts),
              "is not fixed to link '" + body.Name() + "'; left out", warn);
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
  add_sensors(source, body, {}, warn, uav);
  add_fixed_links(source, *model, body, warn, uav);
  add_odometry(source, model->Element(), uav);
  warn_of_moving_joints(source, *model, warn);
  check_sensor_names(source, model->Element(), uav);
  return uav;
}

}  // namespace tether::sim
