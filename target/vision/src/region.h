#pragma once

#include "color_model.h"

#include <optional>
#include <vector>

#include <opencv2/core.hpp>

#include <tether/uav/catalogue.h>
#include <tether/vision/anchor_tracker.h>

namespace tether::vision {

/// Proportions that an upright anchor can have in an image, whatever side is seen.
struct Proportions {
  double min_width_per_height = 0.0;
  double max_width_per_height = 0.0;
  double fill = 1.0;  ///< share of its bounding rectangle that it covers at least
};

Proportions proportions_of(const uav::Anchor& anchor);

/// Rectangle around the connected mass in and near `window`: each side moves to where the profile
/// of `probability` falls off, as often as it takes. None if there is no mass.
std::optional<cv::Rect> fit_rectangle(const cv::Mat& probability, const cv::Rect& window);

/// The ROI that fills `rectangle`. `angle_rad` and `searched_for` are left alone.
Roi measure(const cv::Mat& probability, const cv::Rect& rectangle, const Proportions& proportions);

/// Where the anchor's edges are, to a fraction of a pixel (coordinates as in uav::Pixel).
struct Edges {
  double left_px = 0.0;
  double right_px = 0.0;
  double top_px = 0.0;
  double bottom_px = 0.0;
  double height_px = 0.0;  ///< median over the columns: leaves out corners and things in front
};

/// Finds the edges of what fills `rectangle`. Works on chroma, which, unlike a mask, fades over an
/// edge in proportion to how much of a pixel the anchor covers.
Edges find_edges(const cv::Mat& hsv, const cv::Rect& rectangle, const ColorModel& color);

/// Makes what each region of at least so many pixels encloses as likely as can be: the opening of a
/// gate.
void fill_openings(cv::Mat& probability, int min_area_px);

/// Candidate rectangles in the whole image, the largest first; at most `limit`.
std::vector<cv::Rect> find_blobs(const cv::Mat& probability, int min_area_px, std::size_t limit);

}  // namespace tether::vision
