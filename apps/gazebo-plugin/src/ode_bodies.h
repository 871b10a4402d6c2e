#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <gazebo/ode/ode.h>
#include <gazebo/physics/PhysicsTypes.hh>

#include <tether/sim_protocol/messages.h>
#include <tether/uav/multirotor.h>

namespace tether::gazebo_plugin {

/// The moving bodies in Gazebo's physics engine ODE.
class OdeBodies {
 public:
  OdeBodies() = default;
  /// @throws Error with the name of a body of `open` that the world lacks or that cannot move.
  OdeBodies(const ::gazebo::physics::WorldPtr& world, const sim::protocol::Open& open);

  std::size_t size() const { return bodies_.size(); }
  uav::BodyState state(std::size_t body) const;
  uav::Pose pose(std::size_t body) const;
  /// On the centre of mass, during the next step.
  void push(std::size_t body, const uav::Vec3& force_W, const uav::Vec3& torque_W);
  /// The index of a body; none if it is not one of them.
  std::optional<std::size_t> find(dBodyID id) const;

  /// Back to the poses after the world's own reset, identical to the last bit each time.
  void reset();

 private:
  struct Body {
    dBodyID id = nullptr;
    uav::Vec3 p_BM;  ///< centre of mass
  };
  struct Start {
    dBodyID id = nullptr;
    std::optional<uav::Pose> X_WM;  ///< none before the first reset
  };

  static Body find_body(const ::gazebo::physics::WorldPtr& world, const std::string& model,
                        const std::string& link);
  void remember_starts(const ::gazebo::physics::WorldPtr& world, const sim::protocol::Open& open);

  std::vector<Body> bodies_;
  std::vector<Start> starts_;  ///< of everything dynamic in the world
};

}  // namespace tether::gazebo_plugin
