#pragma once

#include "ode_bodies.h"

#include <cstdint>
#include <optional>
#include <vector>

#include <gazebo/ode/ode.h>

#include <tether/sim_gazebo_plugin/shape_rays.h>
#include <tether/sim_protocol/messages.h>

namespace tether::gazebo_plugin {

/// Distances along rays to the collision shapes of a world. Does not change the world.
class OdeRays {
 public:
  /// `bodies` must outlive it.
  OdeRays(const ::gazebo::physics::WorldPtr& world, const OdeBodies& bodies);
  ~OdeRays();
  OdeRays(const OdeRays&) = delete;
  OdeRays& operator=(const OdeRays&) = delete;

  sim::protocol::Distances cast(const sim::protocol::CastRays& rays);

 private:
  /// The shapes of one body, or of everything that does not move.
  struct Group {
    std::optional<std::size_t> body;
    std::vector<dGeomID> shapes;
  };

  Group& group_of(dGeomID shape);
  double distance_m(const Ray& ray, double max_m, const sim::protocol::CastRays& rays);
  double distance_m(const Ray& ray, double max_m, const std::vector<dGeomID>& shapes);
  double distance_m(const Ray& ray, double max_m, dGeomID shape);
  double distance_by_ode_m(const Ray& ray, double max_m, dGeomID shape);

  const OdeBodies& bodies_;
  std::vector<Group> groups_;
  dGeomID ray_;
};

}  // namespace tether::gazebo_plugin
