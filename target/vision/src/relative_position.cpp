#include <cmath>

#include <tether/base/units.h>
#include <tether/vision/anchor_tracker.h>

namespace tether::vision {
namespace {

/// Viewing direction of a pixel in the body's frame, not normalised.
uav::Vec3 direction_B(const uav::SensorDescription& camera, const uav::CameraModel& model,
                      const uav::Pixel& pixel) {
  return rotate(camera.X_BS.q * uav::q_body_from_optical(), model.unproject(pixel));
}

double bearing_rad(const uav::Vec3& direction_B) {
  return std::atan2(direction_B.y, direction_B.x);
}

double elevation_tangent(const uav::Vec3& direction_B) {
  return direction_B.z / std::hypot(direction_B.x, direction_B.y);
}

/// Mean distance of the visible surface from the anchor's axis, over its width and over the sides
/// from which it may be seen [m].
double surface_to_centre_m(const uav::Anchor& anchor) {
  const uav::Vec3& size = anchor.size_m;
  if (anchor.shape == uav::AnchorShape::kBox) {
    // Half the depth face-on, 0.35 of it edge-on.
    return 0.43 * 0.5 * (size.x + size.y);
  }
  // Mean of √(r² − y²) over the diameter: π/4 · r.
  return 0.3927 * size.x;
}

}  // namespace

RelativePosition relative_position(const uav::SensorDescription& camera, const uav::Anchor& anchor,
                                   const Roi& roi) {
  const uav::CameraModel& model = std::get<uav::CameraProperties>(camera.properties).model;
  const double u = roi.center.u_px;
  const double v = roi.center.v_px;
  const auto bearing_at = [&](double u_px) {
    return bearing_rad(direction_B(camera, model, {u_px, v}));
  };
  const double left = bearing_at(u - 0.5 * roi.width_px);
  const double right = bearing_at(u + 0.5 * roi.width_px);
  RelativePosition position;
  position.bearing_rad = wrap_angle_rad(right + 0.5 * wrap_angle_rad(left - right));

  const uav::Vec3 top_B = direction_B(camera, model, {u, v - 0.5 * roi.edge_height_px});
  const uav::Vec3 bottom_B = direction_B(camera, model, {u, v + 0.5 * roi.edge_height_px});
  const double span = elevation_tangent(top_B) - elevation_tangent(bottom_B);
  if (!roi.cut_above_or_below && span > 0.0) {
    position.distance_m = anchor.size_m.z / span + surface_to_centre_m(anchor);
  }
  return position;
}

}  // namespace tether::vision
