#pragma once

#include <string>

#include <tether/sim/world.h>

namespace tether::sim {

/// The UAV as an SDF 1.6 document: one <model> of its name at its start pose with one link
/// "base_link" of the airframe's mass and inertia, with the body's visuals and collisions; no
/// joint, no sensor. `warn` receives a line for each shape that SDF 1.6 lacks.
std::string to_sdf(const Uav& uav, const WarningSink& warn);

/// Fixed-axis roll, pitch, yaw of the rotation, as uav::from_rpy takes them [rad].
uav::Vec3 to_rpy_rad(const uav::Quat& q);

}  // namespace tether::sim
