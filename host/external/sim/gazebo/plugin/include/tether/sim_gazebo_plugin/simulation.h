#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <tether/sim_protocol/messages.h>

namespace tether::gazebo_plugin {

/// The SDF of a UAV with an inactive camera sensor added to its only link: Gazebo maintains a scene
/// only for a world with a camera. Unchanged without a link.
std::string with_idle_camera(const std::string& sdf);

namespace protocol = sim::protocol;

/// Two shapes that touch, at one point. The numbers of bodies are as in `Simulation::bodies`.
struct TouchedPoint {
  struct Side {
    std::optional<std::size_t> body;  ///< none: it does not move
    std::string model;
    std::uint32_t shape = 0;  ///< a number of its own in the world
  };
  Side sides[2];
  uav::Vec3 p_W;
  uav::Vec3 normal_W;  ///< unit, from the second to the first
};

/// The simulator of a session. Every function may throw Error, whose message is sent to the host;
/// after that no function is called.
class Simulation {
 public:
  virtual ~Simulation() = default;
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  /// Begins to put the UAVs into the world.
  virtual void open(const protocol::Open& open) = 0;
  /// Whether the world is ready for `reset`. Called before each step until it is.
  virtual bool is_ready() = 0;
  /// Name and version, for the record.
  virtual std::string description() const = 0;

  /// Back to the state before the first step.
  virtual void reset(std::uint64_t seed) = 0;
  /// Of the UAVs, then of the other moving bodies.
  virtual std::vector<uav::BodyState> bodies() const = 0;
  /// Force and torque on a UAV's centre of mass during the next step [N, N m].
  virtual void push(std::size_t uav, const uav::Vec3& force_W, const uav::Vec3& torque_W) = 0;

  /// Of anything, at the beginning of the last step.
  virtual std::vector<TouchedPoint> touched_points() const = 0;

  virtual protocol::Distances cast(const protocol::CastRays& rays) = 0;
  virtual protocol::Picture render(const protocol::Render& view) = 0;

 protected:
  Simulation() = default;
};

}  // namespace tether::gazebo_plugin
