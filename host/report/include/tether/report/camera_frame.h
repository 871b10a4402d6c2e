#pragma once

#include <optional>
#include <string>

#include <tether/campaign/metrics.h>
#include <tether/record/reader.h>

/// Recorded camera images with regions of interest, for people (paper, Fig. 5).
namespace tether::report {

/// The region of interest that a SUT reported for an image: its "roi" annotation.
struct ReportedRoi {
  double u_px = 0.0;  ///< centre, right from the centre of the left-most column
  double v_px = 0.0;  ///< centre, down from the centre of the top row
  double width_px = 0.0;
  double height_px = 0.0;
};

/// The ROI that the SUT of `image.uav` reported for that image; none if there is no readable one.
std::optional<ReportedRoi> find_roi(const record::Record& record, const record::Image& image);

/// The true region of an anchor in an image.
struct TrueRoi {
  std::optional<campaign::PixelRect> rect;  ///< none: the anchor is not in the image, or hidden
  /// Of the anchor's visible pixels. Else it is a projection, whatever is in front of the anchor.
  bool is_of_pixels = false;
};

/// The true region of the anchor that the SUT searched for in that image. It is the anchor of the
/// SUT's "estimate" for the image, else of its last estimate before, else of its first, else the
/// only anchor of the record. None if there is no such anchor, or the record does not describe the
/// camera.
std::optional<TrueRoi> find_true_roi(const record::Record& record, const record::Image& image);

enum class ImageQuality {
  kLossless,
  kSmall,  ///< JPEG of a tenth of the size
};

/// The image with frames for both ROIs and a caption: one self-contained SVG.
std::string frame_svg(const record::Image& image, const std::optional<ReportedRoi>& roi,
                      const std::optional<TrueRoi>& true_roi,
                      ImageQuality quality = ImageQuality::kLossless);

/// Whether it has depths; otherwise it has labels.
bool is_depth(const record::RawImage& image);

/// Depths as colours from light (near) to dark (far), or a colour for each model that a label
/// stands for, with a caption that says what the colours mean: one self-contained SVG.
/// @pre one pixel or more
std::string raw_frame_svg(const record::Record& record, const record::RawImage& image,
                          ImageQuality quality = ImageQuality::kLossless);

}  // namespace tether::report
