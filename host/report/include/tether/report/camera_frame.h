#pragma once

#include <optional>
#include <string>

#include <tether/campaign/true_roi.h>
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

/// Where the anchor that the SUT looked for really was in that image: the anchor of its "estimate"
/// for it, else of its last estimate before, else of its first, else the record's only one. None
/// where no anchor can be named, the record does not describe the camera, or nothing of the anchor
/// is in the image.
std::optional<campaign::PixelRect> find_true_roi(const record::Record& record,
                                                 const record::Image& image);

enum class ImageQuality {
  kLossless,
  kSmall,  ///< a tenth of the size
};

/// The image with both ROIs framed and a caption below that says which is which: one
/// self-contained SVG.
std::string frame_svg(const record::Image& image, const std::optional<ReportedRoi>& roi,
                      const std::optional<campaign::PixelRect>& true_roi,
                      ImageQuality quality = ImageQuality::kLossless);

}  // namespace tether::report
