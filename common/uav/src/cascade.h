#pragma once

#include <tether/uav/multirotor.h>

namespace tether::uav {

/// Set-point → thrust and torques, in cascaded loops, of which those above the level of the
/// set-point rest. Advances the controller's part of `state` by `dt`.
/// @pre the level of the set-point is not that of the rotors
Demand control(const MultirotorParameters& parameters, double gravity_m_s2, const BodyState& body,
               const Setpoint& setpoint, double dt_s, MultirotorState& state);

/// The loops that rest begin where the UAV is and as it moves, when a set-point needs them again.
void follow_motion(const BodyState& body, MultirotorState& state);

/// Gains of the outermost loops [1/s].
inline constexpr double kPositionGain_1_s = 1.0;
inline constexpr double kYawGain_1_s = 2.0;

}  // namespace tether::uav
