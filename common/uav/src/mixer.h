#pragma once

#include <array>

#include <tether/uav/multirotor.h>

namespace tether::uav {

/// Collective thrust and torques about the centre of mass, body axes [N, N m].
struct Demand {
  double thrust_N = 0.0;
  Vec3 torque_B_N_m;
};

using RotorThrusts = std::array<double, MultirotorState::kMaxRotors>;  // [N]

double max_rotor_thrust_N(const MultirotorParameters& parameters);

/// Thrust of each rotor that produces `demand`, by the pseudo-inverse of the layout's allocation
/// matrix: the least sum of squares where there are more than four rotors. All within
/// [0, max_rotor_thrust_N]; where that is not enough, yaw torque is scaled down first, then roll
/// and pitch torque.
RotorThrusts mix(const MultirotorParameters& parameters, const Demand& demand);

}  // namespace tether::uav
