#pragma once

#include <vector>

#include <tether/uav/math.h>

namespace tether::sim {

/// The rays that represent a rangefinder's field of view: a cone about x of the given full angle
/// [rad], as RangeModel::rays_S. The middle ray comes first; then four rings at a quarter, half,
/// three quarters and all of the half angle, with 6, 12, 18 and 24 evenly spaced rays, beginning
/// in the x-y plane on y's side. 0 gives the middle ray alone. Objects smaller than the gaps (an
/// eighth of the angle) can be missed.
///
/// @pre 0 ≤ field_of_view_rad ≤ π. Pure; safe from any thread.
std::vector<uav::Vec3> cone_of_rays(double field_of_view_rad);

}  // namespace tether::sim
