#pragma once

#include <optional>
#include <string>

#include <tether/record/reader.h>

/// Recorded camera images as a person looks at them (paper, Fig. 5).
namespace tether::report {

/// The region of interest that a SUT reported for an image: its "roi" annotation.
struct ReportedRoi {
  double u_px = 0.0;  ///< centre, right from the centre of the left-most column
  double v_px = 0.0;  ///< centre, down from the centre of the top row
  double width_px = 0.0;
  double height_px = 0.0;
};

/// What `image.uav` reported for that image; none if it reported nothing that can be read.
std::optional<ReportedRoi> find_roi(const record::Record& record, const record::Image& image);

/// The image with its ROI framed and its ST below: one self-contained SVG.
std::string frame_svg(const record::Image& image, const std::optional<ReportedRoi>& roi);

}  // namespace tether::report
