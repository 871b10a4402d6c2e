#pragma once

#include <optional>

#include <tether/uav/catalogue.h>
#include <tether/vision/anchor_tracker.h>

namespace tether::vision {

/// Where an anchor is, seen from the UAV.
struct RelativePosition {
  /// Angle about the body's z between straight ahead and the anchor, counter-clockwise [rad].
  double bearing_rad = 0.0;
  /// Horizontal distance from the camera to the anchor's centre [m]. None if the anchor is cut off
  /// above or below, because its height is unknown then.
  std::optional<double> distance_m;
};

/// From the ROI and the anchor's known size (paper, Algorithm 2: angle(roi), distance(roi)).
///
/// Bearing: halfway, as an angle, between the viewing directions of the ROI's left and right edges,
/// through the camera's intrinsics (distortion undone) and mounting. (The direction of the ROI's
/// middle pixel would be too far from the image's centre, because the image stretches outwards: by
/// more than 1° for an anchor that is near and at the edge of the image.)
///
/// Distance: from the height of the anchor, because the visible width of a box depends on its
/// heading. A vertical edge of length h at the horizontal distance r spans elevations whose
/// tangents differ by h / r, anywhere in the image. The visible edges are nearer than the centre by
/// about half the anchor's depth, which is added: for a square box of width s, face-on and edge-on
/// views differ by 0.15·s, of which the mean is taken.
///
/// Assumes an upright anchor and a level UAV. Thread-safe. @pre `camera` is a camera
RelativePosition relative_position(const uav::SensorDescription& camera, const uav::Anchor& anchor,
                                   const Roi& roi);

}  // namespace tether::vision
