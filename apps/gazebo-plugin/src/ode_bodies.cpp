#include "ode_bodies.h"

#include "conversions.h"
#include "links.h"

#include <algorithm>

#include <gazebo/physics/ode/ODELink.hh>
#include <gazebo/physics/physics.hh>

#include <tether/base/error.h>

namespace tether::gazebo_plugin {
namespace {

using uav::Pose;
using uav::Vec3;

Vec3 vec3_from(const dReal* v) {
  return {v[0], v[1], v[2]};
}

Pose pose_of_mass(dBodyID id) {
  const dReal* q = dBodyGetQuaternion(id);
  return {vec3_from(dBodyGetPosition(id)), {q[0], q[1], q[2], q[3]}};
}

// ODE knows a body by its centre of mass, in the link's axes.
dBodyID ode_body(const ::gazebo::physics::LinkPtr& link) {
  const auto ode = boost::dynamic_pointer_cast<::gazebo::physics::ODELink>(link);
  return ode ? ode->GetODEId() : nullptr;
}

// A free body then follows the equations of Newton and Euler: semi-implicit, with the exact
// rotation of a step.
void let_fly(dBodyID id) {
  dBodySetAutoDisableFlag(id, 0);
  dBodySetLinearDamping(id, 0.0);
  dBodySetAngularDamping(id, 0.0);
  dBodySetMaxAngularSpeed(id, dInfinity);
  dBodySetGyroscopicMode(id, 1);
  dBodySetFiniteRotationMode(id, 1);
}

void put(dBodyID id, const Pose& X) {
  const dQuaternion q{X.q.w, X.q.x, X.q.y, X.q.z};
  dBodySetPosition(id, X.p.x, X.p.y, X.p.z);
  dBodySetQuaternion(id, q);
  dBodySetLinearVel(id, 0.0, 0.0, 0.0);
  dBodySetAngularVel(id, 0.0, 0.0, 0.0);
  dBodySetForce(id, 0.0, 0.0, 0.0);
  dBodySetTorque(id, 0.0, 0.0, 0.0);
  dBodyEnable(id);
}

}  // namespace

OdeBodies::OdeBodies(const ::gazebo::physics::WorldPtr& world, const sim::protocol::Open& open) {
  for (const sim::protocol::UavDescription& uav : open.uavs) {
    bodies_.push_back(find_body(world, uav.name, "base_link"));
    let_fly(bodies_.back().id);
  }
  for (const sim::protocol::BodyName& body : open.bodies) {
    bodies_.push_back(find_body(world, body.model, body.link));
  }
  remember_starts(world, open);
}

OdeBodies::Body OdeBodies::find_body(const ::gazebo::physics::WorldPtr& world,
                                     const std::string& model, const std::string& link) {
  const std::string name = model + "::" + link;
  const auto found =
      boost::dynamic_pointer_cast<::gazebo::physics::Link>(world->EntityByName(name));
  if (!found) {
    throw Error(ErrorCode::kSetup, "Gazebo's world has no link '" + name +
                                       "'; load the world file of the scenario in gzserver");
  }
  const dBodyID id = ode_body(found);
  if (!id) {
    throw Error(ErrorCode::kSetup,
                "link '" + name +
                    "' does not move in Gazebo's world; load the world file of the scenario in "
                    "gzserver, with <physics type=\"ode\">");
  }
  return {id, from_gazebo(found->GetInertial()->CoG())};
}

void OdeBodies::remember_starts(const ::gazebo::physics::WorldPtr& world,
                                const sim::protocol::Open& open) {
  for (std::size_t i = 0; i < open.uavs.size(); ++i) {
    starts_.push_back({bodies_[i].id, open.uavs[i].X_WB});
  }
  for_each_link(world, [&](const ::gazebo::physics::LinkPtr& link) {
    const dBodyID id = ode_body(link);
    const auto is_uav = [&](const Start& start) { return start.id == id; };
    if (id && std::none_of(starts_.begin(), starts_.end(), is_uav))
      starts_.push_back({id, std::nullopt});
  });
}

Pose OdeBodies::pose(std::size_t body) const {
  const Pose X_WM = pose_of_mass(bodies_[body].id);
  return {X_WM.p - rotate(X_WM.q, bodies_[body].p_BM), X_WM.q};
}

uav::BodyState OdeBodies::state(std::size_t body) const {
  const auto& [id, p_BM] = bodies_[body];
  const Pose X_WB = pose(body);
  const Vec3 w_W = vec3_from(dBodyGetAngularVel(id));
  const Vec3 v_WB = vec3_from(dBodyGetLinearVel(id)) - cross(w_W, rotate(X_WB.q, p_BM));
  return {X_WB.p, X_WB.q, v_WB, rotate(inverse(X_WB.q), w_W)};
}

void OdeBodies::push(std::size_t body, const Vec3& force_W, const Vec3& torque_W) {
  const dBodyID id = bodies_[body].id;
  dBodyAddForce(id, force_W.x, force_W.y, force_W.z);
  dBodyAddTorque(id, torque_W.x, torque_W.y, torque_W.z);
}

std::optional<std::size_t> OdeBodies::find(dBodyID id) const {
  const auto found =
      std::find_if(bodies_.begin(), bodies_.end(), [&](const Body& body) { return body.id == id; });
  if (!id || found == bodies_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - bodies_.begin());
}

void OdeBodies::reset() {
  for (Start& start : starts_) {
    if (!start.X_WM) start.X_WM = pose_of_mass(start.id);
    put(start.id, *start.X_WM);
  }
}

}  // namespace tether::gazebo_plugin
