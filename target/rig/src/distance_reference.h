#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tether/base/result.h>
#include <tether/client/vehicle.h>
#include <tether/uav/catalogue.h>

/// The distance that an estimate is compared with, from a rangefinder beside the camera (paper,
/// Section IV: "the distance ground truth with the onboard camera is obtained with a VL53L1X").
namespace tether::rig {

/// What an estimate means: the horizontal distance from the camera to the anchor's centre.
struct DistanceReference {
  std::optional<double> distance_m;
  std::string why_none;  ///< for a person, if there is no distance
};

/// The median of those readings that found something within range [m]; none if fewer than half of
/// them did.
std::optional<double> median_of_finite_m(std::vector<double> readings_m);

/// From a rangefinder's reading: along the horizontal line of sight at `bearing_rad`, from the
/// camera to where the rangefinder's beam ends, by the mounting of both, and from there half the
/// anchor's depth on to its centre (a box: half its size along its own x; a cylinder or a sphere:
/// its radius).
///
/// Assumes that the body is level, that the beam ends on the anchor, and that a box faces the
/// camera. None where the beam ends beside the anchor as seen from the camera: further from the
/// line of sight than half the anchor's width.
DistanceReference reference_from(double range_m, const uav::SensorDescription& range,
                                 const uav::SensorDescription& camera, const uav::Anchor& anchor,
                                 double bearing_rad);

/// The same from the median of ten readings of the catalogue's first rangefinder, if it has one.
/// Fails as the read does. @pre `camera` is of the vehicle's catalogue
Result<DistanceReference> take_distance_reference(client::Vehicle& vehicle,
                                                  const uav::SensorDescription& camera,
                                                  const uav::Anchor& anchor, double bearing_rad);

}  // namespace tether::rig
