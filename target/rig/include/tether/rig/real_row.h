#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tether/client/vehicle.h>
#include <tether/rig/mission.h>
#include <tether/tasks/paper_tasks.h>
#include <tether/tasks/task.h>

/// The row "Real sensor" of the paper's Table II: "compute relative position" on real input.
namespace tether::rig {

/// A rectangle of whole pixels, as an image editor selects it.
struct PixelBox {
  double left_px = 0.0;  ///< of its left-most column
  double top_px = 0.0;   ///< of its top row
  double width_px = 0.0;
  double height_px = 0.0;
};

struct RealRowOptions {
  std::optional<PixelBox> true_roi;  ///< of the anchor in the image, as a person annotated it
  std::string keep_image;            ///< file for the image of the last estimate; empty: none
};

struct RealRow {
  /// The outcome of the task, with these additional results if known: "angle_error_deg",
  /// "distance_error_m" (both absolute, as in the paper) and "distance_reference_m".
  tasks::TaskOutcome outcome;
  std::optional<tasks::RelativePositionTask::Sighting> sighting;
  /// Why there is no reference, for a person; one line each.
  std::vector<std::string> notes;
};

/// Runs the task, then measures the distance reference with the catalogue's first rangefinder, if
/// it has one, and compares. The reference does not count as time of the task. Does not `finish`.
/// @pre `spec` is of a relative_position task
RealRow measure_real_row(const TaskSpec& spec, const std::optional<PixelBox>& true_roi,
                         client::Vehicle& vehicle);

/// The row and that of the paper, with "-" for unknown values. `location`: where the SUT ran.
std::string table_2(const RealRow& row, const std::string& location);

/// X,Y,W,H of an estimate's ROI in whole pixels, as in --true-roi-px.
std::string to_pixel_box(const vision::Roi& roi);

}  // namespace tether::rig
