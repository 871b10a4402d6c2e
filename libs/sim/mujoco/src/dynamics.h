#pragma once

#include "engine.h"
#include "pose_history.h"

#include <span>
#include <vector>

#include <tether/base/time.h>
#include <tether/sim/bodies.h>
#include <tether/sim/world.h>
#include <tether/uav/multirotor.h>

namespace tether::sim {

/// What an IMU needs of one UAV beside its pose: the motion of the body origin over the last step,
/// constant within it.
struct BodyMotion {
  uav::Vec3 w_WB_B;      ///< angular velocity now [rad/s]
  uav::Vec3 a_WB_W;      ///< acceleration of B's origin over the last step [m/s²]
  uav::Vec3 alpha_WB_B;  ///< angular acceleration over the last step [rad/s²]
};

/// The moving part of the world: rigid bodies, contacts, rotors and controllers.
///
/// The layout of a captured state is: position and quaternion of each moving body (7 numbers each),
/// then the BodyMotion of each UAV (9 numbers each), then the positions and quaternions again at
/// each past step that some camera's shutter reaches back to, oldest first (none without a
/// shutter). What was before ST 0 is as at ST 0.
class Dynamics {
 public:
  /// `world` must outlive this object.
  Dynamics(const World& world, const WarningSink& warn);

  /// Start poses, UAVs hovering, zero commands. Allocates nothing.
  void reset();
  void set_command(std::size_t uav, const uav::VelocityCommand& command);
  /// One step: controllers and rotors see the state at its beginning, the engine does the rest.
  /// Allocates nothing.
  /// @throws Error(kSetup) when the engine finds the state unusable (not finite or out of bounds).
  void step();

  void capture(std::vector<double>& state) const;
  uav::BodyState body_state(std::size_t uav) const;
  const mjModel& model() const { return *model_; }
  /// Whether more contacts occurred at once than the engine keeps; those were ignored.
  bool contacts_dropped() const;

  static uav::Pose pose_of(const std::vector<double>& state, std::size_t body);
  BodyMotion motion_of(const std::vector<double>& state, std::size_t uav) const;
  /// Where a body was `steps_ago` steps before the capture, a whole number or between two. @pre not
  /// negative, and within the longest shutter.
  uav::Pose past_pose_of(const std::vector<double>& state, std::size_t body,
                         double steps_ago) const;

 private:
  struct Flight {
    const uav::MultirotorParameters* airframe;
    uav::VelocityCommand command;
    uav::MultirotorState state;
  };

  void apply_rotors(std::size_t uav);
  void check_engine() const;
  std::span<const double> poses() const;

  const World& world_;
  std::size_t bodies_ = 0;
  ModelPtr model_;
  DataPtr data_;
  std::vector<Flight> flights_;
  PoseHistory past_;
};

}  // namespace tether::sim
