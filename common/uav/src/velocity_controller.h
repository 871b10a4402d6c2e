#pragma once

#include <tether/uav/multirotor.h>

namespace tether::uav {

/// Velocity and yaw rate → thrust and torques, in three cascaded loops. Advances the controller's
/// part of `state` by `dt`.
Demand control(const MultirotorParameters& parameters, double gravity_m_s2, const BodyState& body,
               const VelocityCommand& command, double dt_s, MultirotorState& state);

}  // namespace tether::uav
