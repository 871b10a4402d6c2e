#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tether/base/time.h>
#include <tether/record/reader.h>
#include <tether/scenario/metric.h>
#include <tether/uav/math.h>

/// Metrics of a run, computed from its record alone: from ground truth (paper, Section V), and the
/// errors of the SUT's own estimates (Tables II and V). Pure functions.
namespace tether::campaign {

struct MetricValue {
  std::string name;
  std::string kind;
  std::string label;
  std::string unit;             ///< of `value` and `max`
  std::optional<double> value;  ///< none: see `missing_because`
  std::string missing_because;  ///< one line; empty if there is a value
  std::optional<double> max;
  std::optional<double> min{};  ///< of kinds of which more is better

  /// Whether there is a value within its limits.
  bool is_met() const { return value && (!max || *value <= *max) && (!min || *value >= *min); }
  /// As its kind says.
  bool is_better_if_more() const;

  friend bool operator==(const MetricValue&, const MetricValue&) = default;
};

/// One value per metric, in their order. A metric that cannot be computed from the record has no
/// value, but a reason.
std::vector<MetricValue> compute_metrics(std::span<const scenario::Metric> metrics,
                                         const record::Record& record);

/// The horizontal angle from the UAV's heading to the anchor's centre, both in W's x-y plane:
/// positive to the left, in (−π, π] [rad].
double true_bearing_rad(const record::GroundTruth& uav, const record::Anchor& anchor);

/// How often a UAV turned too far (paper, Table III): an overshoot is counted if the bearing was
/// beyond the threshold on one side, passes through zero, and is beyond the threshold on the other
/// side. Passing the anchor by less than the threshold, jitter around zero, and turning through ±π
/// (the anchor behind the UAV) do not count.
/// @param bearings_rad in (−π, π], in order of time, less than half a turn apart.
/// @pre threshold_rad ≥ 0.
int count_overshoots(std::span<const double> bearings_rad, double threshold_rad);

/// ST at which the SUT of `uav` asked to finish; none if it did not. Under the barrier that is the
/// request's own timestamp; in free running, the ST of its arrival (docs/design.md section 2, rule
/// 8).
std::optional<SimTime> finish_time(const record::Record& record, const std::string& uav);

// ---- The true position of an anchor in an image, from the record's ground truth; replaces the
// hand-annotated ROI of the paper (Table II). Pure functions.

/// A rectangle in an image. Pixel centres are whole numbers, (0, 0) in the upper left, so that an
/// image of `width_px` columns reaches from −0.5 to width_px − 0.5.
struct PixelRect {
  double left_px = 0.0;
  double top_px = 0.0;
  double right_px = 0.0;
  double bottom_px = 0.0;

  friend bool operator==(const PixelRect&, const PixelRect&) = default;
};

/// The pose of a camera's body-style frame S in W.
/// @pre camera.camera has a value.
uav::Pose camera_pose(const record::SensorInfo& camera, const uav::Pose& X_WB);

/// The bounding rectangle of the whole anchor, projected into the camera's image plane, including
/// any part beyond the image: of a box by its edges, of a cylinder by its rims, of a sphere by its
/// silhouette. None if a part is behind the camera or so far aside that the lens has no image of
/// it, if the anchor has another shape, or if the record does not describe the camera.
std::optional<PixelRect> true_roi(const record::SensorInfo& camera, const uav::Pose& X_WB,
                                  const record::Anchor& anchor);

/// The true region of an anchor in an image that was read. If the record has what is seen of
/// anchors, it is the rectangle around the anchor's visible pixels, and none if there are none:
/// each edge is that of the projection (`true_roi`) where the pixels reach it, and else that of the
/// pixels. If not, it is the projection, whatever is in front of the anchor.
std::optional<PixelRect> roi_in_image(const record::Interaction& read,
                                      const record::SensorInfo& camera, const uav::Pose& X_WB,
                                      const record::Anchor& anchor);

/// The read of a measurement; nullptr if the record has none.
const record::Interaction* find_read(const record::Record& record, const std::string& uav,
                                     const std::string& sensor, std::uint64_t index);

/// The part of `roi` that is in the image; none if there is no such part.
/// @pre camera.camera has a value.
std::optional<PixelRect> visible_part(const record::SensorInfo& camera, const PixelRect& roi);

/// Whether a part of `roi`, or all of it, is beyond the image.
/// @pre camera.camera has a value.
bool is_cut(const record::SensorInfo& camera, const PixelRect& roi);

/// The bearing of a ROI [rad], as in vision::relative_position: the middle, as an angle about the
/// body's z, between the viewing directions of its left and right edges; positive to the left.
/// @pre camera.camera has a value.
double roi_bearing_rad(const record::SensorInfo& camera, const PixelRect& roi);

}  // namespace tether::campaign
