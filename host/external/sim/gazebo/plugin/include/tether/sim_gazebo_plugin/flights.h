#pragma once

#include <cstddef>
#include <vector>

#include <tether/sim_protocol/messages.h>
#include <tether/uav/multirotor.h>

namespace tether::gazebo_plugin {

/// Rotors and controllers of the UAVs: the same multirotor as in every other simulator.
class Flights {
 public:
  Flights() = default;
  explicit Flights(const sim::protocol::Open& open);

  std::size_t size() const { return flights_.size(); }
  /// Hovering at the start poses, without a set-point.
  void reset();
  void set_setpoint(std::size_t uav, const uav::Setpoint& setpoint);
  /// One step of a UAV, with its body at the beginning of the step.
  uav::Wrench step(std::size_t uav, const uav::BodyState& body);

 private:
  struct Flight {
    uav::Multirotor multirotor;
    double start_yaw_rad = 0.0;
    uav::Setpoint setpoint;
    uav::MultirotorState state;
  };

  double gravity_m_s2_ = 0.0;
  std::vector<Flight> flights_;
};

}  // namespace tether::gazebo_plugin
