#pragma once

#include <memory>
#include <optional>

#include <tether/base/result.h>
#include <tether/uav/camera_model.h>
#include <tether/uav/catalogue.h>
#include <tether/uav/samples.h>

namespace tether::vision {

/// Where an anchor appears in an image: the paper's region of interest (Section III, Algorithm 2).
/// Pixel coordinates as in uav::Pixel.
struct Roi {
  uav::Pixel center;       ///< of the upright bounding rectangle
  double width_px = 0.0;   ///< of the upright bounding rectangle
  double height_px = 0.0;  ///< of the upright bounding rectangle
  double angle_rad = 0.0;  ///< of the region's long axis, clockwise from the image's right
  double score = 0.0;      ///< how well colour, fill and proportions fit the anchor, 0..1

  /// Height that the anchor's visible vertical edges have [px], to a fraction of a pixel.
  double edge_height_px = 0.0;

  bool cut_left_or_right = false;  ///< touches that border of the image: more of it may be outside
  bool cut_above_or_below = false;
  bool searched_for = false;  ///< found by a search of the whole image, not from the last window
};

/// Smoothing of the image before its colours are evaluated.
enum class Prefilter { kNone, kGaussian, kMedian };

struct TrackerOptions {
  Prefilter prefilter = Prefilter::kGaussian;
  int prefilter_size_px = 5;        ///< odd
  double hue_tolerance_deg = 14.0;  ///< about the anchor's hue
  double min_saturation = 0.30;     ///< 0..1; paler pixels have no reliable hue
  double min_value = 0.12;          ///< 0..1; darker pixels have no reliable hue
  double max_value = 1.0;           ///< 0..1
  int min_area_px = 30;             ///< smaller regions are noise
  double min_score = 0.40;          ///< below it the anchor counts as lost
  double max_area_change = 3.0;  ///< factor between images beyond which the window is not trusted
  /// The anchor has an opening, as a gate: what its parts enclose counts as part of it.
  bool is_hollow = false;
};

/// Follows one anchor of known colour through a sequence of images with CamShift (Bradski,
/// "Computer vision face tracking for use in a perceptual user interface", Intel Technology Journal
/// 1998; the paper's reference 29): back-projection of a hue histogram, masked by saturation and
/// value.
///
/// The histogram is computed from the anchor's colour, without a manual selection. The whole image
/// is searched at first and whenever the anchor was lost; else CamShift continues from the last
/// window. Every image is filtered, converted and back-projected as a whole.
///
/// Movable; not thread-safe. The result depends on the images only. Throws only bad_alloc.
class AnchorTracker {
 public:
  /// Fails with kInvalid if the anchor's colour has no reliable hue (grey or too dark), if its size
  /// is 0, or for an unusable option.
  static Result<AnchorTracker> create(const uav::Anchor& anchor,
                                      const TrackerOptions& options = {});
  AnchorTracker(AnchorTracker&&) noexcept;
  AnchorTracker& operator=(AnchorTracker&&) noexcept;
  ~AnchorTracker();

  /// The anchor's region in the image [px]; none if the anchor is not seen, or if image.rgb does
  /// not have width × height × 3 bytes.
  std::optional<Roi> track(const uav::CameraSample& image);

  // The steps of `track` in this order, to measure the time of each. The image must outlive them.
  // @pre image.rgb has width × height × 3 bytes
  void prefilter(const uav::CameraSample& image);
  void back_project();
  std::optional<Roi> locate();

  /// Forgets the window: the next image is searched whole.
  void reset();

 private:
  struct Impl;
  explicit AnchorTracker(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

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

/// Sets the number of threads for image processing in the whole process; 1: only the caller's. A
/// SUT whose time is the CPU time of its process must use 1.
void set_threads(int count);

/// Tracks an anchor through a few generated images of this size, so that one-time costs (lazy
/// initialisation, page faults) occur before a SUT's time begins.
void warm_up(int width_px, int height_px);

}  // namespace tether::vision
