#include "ode_rays.h"

#include "links.h"

#include <algorithm>
#include <array>
#include <limits>

#include <gazebo/physics/ode/ODECollision.hh>

#include <tether/sim_gazebo_plugin/shape_rays.h>

namespace tether::gazebo_plugin {
namespace {

constexpr double kNothing = std::numeric_limits<double>::infinity();
// A ray may hit a mesh several times.
constexpr int kMaxHits = 8;

uav::Vec3 in_frame_of(dGeomID shape, const uav::Vec3& v_W) {
  const dReal* R = dGeomGetRotation(shape);
  return {R[0] * v_W.x + R[4] * v_W.y + R[8] * v_W.z, R[1] * v_W.x + R[5] * v_W.y + R[9] * v_W.z,
          R[2] * v_W.x + R[6] * v_W.y + R[10] * v_W.z};
}

Ray in_frame_of(dGeomID shape, const Ray& ray) {
  const dReal* p = dGeomGetPosition(shape);
  return {in_frame_of(shape, ray.origin - uav::Vec3{p[0], p[1], p[2]}),
          in_frame_of(shape, ray.direction)};
}

double distance_to_box_m(const Ray& ray, dGeomID box) {
  dVector3 size;
  dGeomBoxGetLengths(box, size);
  return distance_to_box_m(in_frame_of(box, ray), {size[0], size[1], size[2]});
}

double distance_to_cylinder_m(const Ray& ray, dGeomID cylinder) {
  dReal radius = 0.0;
  dReal length = 0.0;
  dGeomCylinderGetParams(cylinder, &radius, &length);
  return distance_to_cylinder_m(in_frame_of(cylinder, ray), radius, length);
}

}  // namespace

OdeRays::OdeRays(const ::gazebo::physics::WorldPtr& world, const OdeBodies& bodies)
    : bodies_(bodies), ray_(dCreateRay(nullptr, 1.0)) {
  dGeomRaySetClosestHit(ray_, 1);
  for_each_link(world, [this](const ::gazebo::physics::LinkPtr& link) {
    for (const auto& collision : link->GetCollisions()) {
      const auto ode = boost::dynamic_pointer_cast<::gazebo::physics::ODECollision>(collision);
      if (!ode || !ode->GetCollisionId()) continue;
      group_of(ode->GetCollisionId()).shapes.push_back(ode->GetCollisionId());
    }
  });
}

OdeRays::~OdeRays() {
  dGeomDestroy(ray_);
}

OdeRays::Group& OdeRays::group_of(dGeomID shape) {
  const std::optional<std::size_t> body = bodies_.find(dGeomGetBody(shape));
  const auto found = std::find_if(groups_.begin(), groups_.end(),
                                  [&](const Group& group) { return group.body == body; });
  if (found != groups_.end()) return *found;
  groups_.push_back({body, {}});
  return groups_.back();
}

sim::protocol::Distances OdeRays::cast(const sim::protocol::CastRays& rays) {
  sim::protocol::Distances distances;
  for (const uav::Vec3& direction_S : rays.rays_S) {
    distances.distance_m.push_back(
        distance_m(ray_in_world(rays.X_WS, direction_S), rays.max_m, rays));
  }
  return distances;
}

double OdeRays::distance_m(const Ray& ray, double max_m, const sim::protocol::CastRays& rays) {
  double nearest_m = kNothing;
  for (const Group& group : groups_) {
    if (group.body && group.body == rays.carrier) continue;
    const Ray there =
        group.body ? ray_to_body_now(ray, rays.X_WB[*group.body], bodies_.pose(*group.body)) : ray;
    nearest_m = std::min(nearest_m, distance_m(there, max_m, group.shapes));
  }
  return nearest_m;
}

double OdeRays::distance_m(const Ray& ray, double max_m, const std::vector<dGeomID>& shapes) {
  double nearest_m = kNothing;
  for (const dGeomID shape : shapes) nearest_m = std::min(nearest_m, distance_m(ray, max_m, shape));
  return nearest_m <= max_m ? nearest_m : kNothing;
}

// ODE's own rays report hits beside cylinders.
double OdeRays::distance_m(const Ray& ray, double max_m, dGeomID shape) {
  switch (dGeomGetClass(shape)) {
    case dBoxClass:
      return distance_to_box_m(ray, shape);
    case dCylinderClass:
      return distance_to_cylinder_m(ray, shape);
    case dSphereClass:
      return distance_to_sphere_m(in_frame_of(shape, ray), dGeomSphereGetRadius(shape));
    default:
      return distance_by_ode_m(ray, max_m, shape);
  }
}

double OdeRays::distance_by_ode_m(const Ray& ray, double max_m, dGeomID shape) {
  dGeomRaySetLength(ray_, max_m);
  dGeomRaySet(ray_, ray.origin.x, ray.origin.y, ray.origin.z, ray.direction.x, ray.direction.y,
              ray.direction.z);
  std::array<dContactGeom, kMaxHits> hits;
  const int count = dCollide(ray_, shape, kMaxHits, hits.data(), sizeof hits[0]);
  double nearest_m = kNothing;
  for (int i = 0; i < count; ++i) {
    nearest_m = std::min(nearest_m, static_cast<double>(hits[static_cast<std::size_t>(i)].depth));
  }
  return nearest_m;
}

}  // namespace tether::gazebo_plugin
