#pragma once

#include <optional>
#include <string>

#include <tether/base/time.h>
#include <tether/record/reader.h>
#include <tether/uav/math.h>

/// Where an anchor really is in an image, from the record's ground truth: what stands in for the
/// hand-annotated ROI of the paper (Table II). Pure functions.
namespace tether::campaign {

/// A rectangle in an image. Pixel centres are whole numbers, (0, 0) in the upper left, so that an
/// image of `width_px` columns reaches from −0.5 to width_px − 0.5.
struct PixelRect {
  double left_px = 0.0;
  double top_px = 0.0;
  double right_px = 0.0;
  double bottom_px = 0.0;

  friend bool operator==(const PixelRect&, const PixelRect&) = default;
};

/// X_WB of a UAV at an instant, between the two ground truths around it: the position linearly, the
/// attitude along the shortest arc. Up to one ground-truth period before the first or behind the
/// last, that one's pose; further outside, and of an unknown UAV, none.
std::optional<uav::Pose> pose_at(const record::Record& record, const std::string& uav,
                                 SimTime instant);

/// The pose of a camera's body-style frame S in W.
/// @pre camera.camera is there.
uav::Pose camera_pose(const record::SensorInfo& camera, const uav::Pose& X_WB);

/// The bounding rectangle of the whole anchor as projected into the camera's image plane: also of
/// what lies outside the image. Of a box by its edges, of a cylinder by its rims, of a sphere by
/// its silhouette. None when any of that is behind the camera or so far aside that the lens has no
/// image of it, when the anchor has another shape, and when the record does not describe the
/// camera.
std::optional<PixelRect> true_roi(const record::SensorInfo& camera, const uav::Pose& X_WB,
                                  const record::Anchor& anchor);

/// The part of it that is in the image; none: nothing is.
/// @pre camera.camera is there.
std::optional<PixelRect> visible_part(const record::SensorInfo& camera, const PixelRect& roi);

/// Whether the image's border cuts a part of it off, or all.
/// @pre camera.camera is there.
bool is_cut(const record::SensorInfo& camera, const PixelRect& roi);

/// The bearing of what a ROI shows [rad], as vision::relative_position takes it: halfway, as an
/// angle about the body's z, between the viewing directions of its left and right edges; positive
/// to the left.
/// @pre camera.camera is there.
double roi_bearing_rad(const record::SensorInfo& camera, const PixelRect& roi);

}  // namespace tether::campaign
