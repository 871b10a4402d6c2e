#pragma once

#include <vector>

#include <tether/base/result.h>
#include <tether/uav/catalogue.h>
#include <tether/uav/samples.h>

/// What `calibrate` looks at: images that the simulator's renderer drew
/// (tools/render_calibration_frames.cpp), compiled into this program.
namespace tether::calibration {

/// Six images of 640 × 480 pixels in which a UAV turns towards the box, with the camera's noise:
/// the same bytes on every machine. Fails (kInvalid) where OpenCV cannot read JPEG.
Result<std::vector<uav::CameraSample>> calibration_frames();

/// The camera that took them, and the anchor in them.
uav::SensorDescription calibration_camera();
uav::Anchor calibration_anchor();

/// Where the anchor is in an image, and which way.
struct View {
  double u_px, v_px;  ///< the ROI's centre
  double width_px, height_px;
  double bearing_deg;
  double distance_m;
};
/// What any machine must find in them.
const std::vector<View>& expected_views();

}  // namespace tether::calibration
