#include "color_model.h"
#include "region.h"

#include <cmath>
#include <string>
#include <utility>

#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include <tether/base/units.h>
#include <tether/vision/anchor_tracker.h>

// Tracks one anchor in three steps: prefilter, back-projection of its colour, location. Location
// runs CamShift from the last window and, if that loses the anchor, searches the whole image among
// the candidates of region.h.
namespace tether::vision {
namespace {

constexpr std::size_t kMaxCandidates = 8;

bool is_share(double value) {
  return value >= 0.0 && value <= 1.0;
}

/// An empty string if the options can be used.
std::string fault_of(const TrackerOptions& o) {
  if (o.prefilter != Prefilter::kNone &&
      (o.prefilter_size_px < 1 || o.prefilter_size_px > 31 || o.prefilter_size_px % 2 == 0)) {
    return "prefilter_size_px must be odd and from 1 to 31";
  }
  if (!(o.hue_tolerance_deg > 0.0 && o.hue_tolerance_deg <= 90.0)) {
    return "hue_tolerance_deg must be greater than 0 and at most 90";
  }
  if (!is_share(o.min_saturation) || !is_share(o.min_value) || !is_share(o.max_value) ||
      !is_share(o.min_score)) {
    return "min_saturation, min_value and min_score must be from 0 to 1";
  }
  if (o.min_area_px < 1 || !(o.max_area_change > 1.0)) {
    return "min_area_px must be at least 1, and max_area_change greater than 1";
  }
  return "";
}

bool is_whole(const uav::CameraSample& image) {
  return image.width_px > 0 && image.height_px > 0 &&
         image.rgb.size() == 3 * static_cast<std::size_t>(image.width_px) *
                                 static_cast<std::size_t>(image.height_px);
}

}  // namespace

struct AnchorTracker::Impl {
  Impl(const uav::Anchor& anchor, const TrackerOptions& tracker_options)
      : options(tracker_options),
        proportions(proportions_of(anchor)),
        color(anchor.color_rgb, tracker_options) {}

  TrackerOptions options;
  Proportions proportions;
  ColorModel color;
  std::optional<cv::Rect> window;  // where the anchor was in the last image; none: lost
  // Kept between images, so that their memory is.
  cv::Mat filtered, hsv, probability;
  cv::Mat smooth;  // `filtered`, or a view of the last image

  void filter(const uav::CameraSample& image);
  std::optional<Roi> follow_window();
  std::optional<Roi> search();
  bool is_plausible(const Roi& roi) const;
  bool has_jumped(const Roi& roi, const cv::Rect& from) const;
};

/// The whole image. Afterwards `smooth` is the image itself if there is no filter.
void AnchorTracker::Impl::filter(const uav::CameraSample& image) {
  // OpenCV has no view of constant data; this one is only read.
  const cv::Mat rgb(image.height_px, image.width_px, CV_8UC3,
                    const_cast<std::uint8_t*>(image.rgb.data()));  // NOLINT
  const int size = options.prefilter_size_px;
  switch (options.prefilter) {
    case Prefilter::kNone:
      smooth = rgb;
      return;
    case Prefilter::kGaussian:
      cv::GaussianBlur(rgb, filtered, {size, size}, 0);
      break;
    case Prefilter::kMedian:
      cv::medianBlur(rgb, filtered, size);
      break;
  }
  smooth = filtered;
}

bool AnchorTracker::Impl::is_plausible(const Roi& roi) const {
  return roi.score >= options.min_score && roi.width_px * roi.height_px >= options.min_area_px;
}

/// Whether the area changed more than an anchor's does between images. One that is being cut off by
/// the border may.
bool AnchorTracker::Impl::has_jumped(const Roi& roi, const cv::Rect& from) const {
  const double change = roi.width_px * roi.height_px / from.area();
  const bool is_cut = roi.cut_left_or_right || roi.cut_above_or_below;
  return !is_cut && (change > options.max_area_change || change * options.max_area_change < 1.0);
}

std::optional<Roi> AnchorTracker::Impl::follow_window() {
  const cv::Rect last = *window & cv::Rect({0, 0}, probability.size());
  if (last.empty() || cv::countNonZero(probability(last)) == 0) return std::nullopt;
  cv::Rect shifted = last;
  const cv::TermCriteria criteria(cv::TermCriteria::EPS | cv::TermCriteria::COUNT, 10, 1.0);
  const cv::RotatedRect box = cv::CamShift(probability, shifted, criteria);
  const std::optional<cv::Rect> rectangle = fit_rectangle(probability, shifted);
  if (!rectangle) return std::nullopt;
  Roi roi = measure(probability, *rectangle, proportions);
  if (!is_plausible(roi) || has_jumped(roi, last)) return std::nullopt;
  // CamShift's angle is that of the box's height, and its height is the longer side.
  roi.angle_rad = std::remainder(rad_from_deg(box.angle + 90.0), rad_from_deg(180.0));
  window = rectangle;
  return roi;
}

/// The candidate that fits best, where a larger one may fit a little less.
std::optional<Roi> AnchorTracker::Impl::search() {
  std::optional<Roi> best;
  double best_rank = 0.0;
  window.reset();
  for (const cv::Rect& blob : find_blobs(probability, options.min_area_px, kMaxCandidates)) {
    const Roi roi = measure(probability, blob, proportions);
    const double rank = roi.score * std::sqrt(roi.width_px * roi.height_px);
    if (is_plausible(roi) && rank > best_rank) {
      best = roi;
      best_rank = rank;
      window = blob;
    }
  }
  if (!best) return std::nullopt;
  // From there as in any other image, so that a ROI means the same however it was found.
  if (std::optional<Roi> followed = follow_window()) best = followed;
  best->searched_for = true;
  return best;
}

Result<AnchorTracker> AnchorTracker::create(const uav::Anchor& anchor,
                                            const TrackerOptions& options) {
  if (const std::string fault = fault_of(options); !fault.empty()) {
    return Failure{Failure::Kind::kInvalid, fault};
  }
  const HueSaturationValue color = hsv_from_rgb(anchor.color_rgb);
  if (color.saturation < options.min_saturation || color.value < options.min_value) {
    return Failure{
        Failure::Kind::kInvalid,
        "anchor \"" + anchor.name + "\" is too pale or too dark to be tracked by its colour"};
  }
  if (!(anchor.size_m.x > 0.0 && anchor.size_m.y > 0.0 && anchor.size_m.z > 0.0)) {
    return Failure{Failure::Kind::kInvalid, "anchor \"" + anchor.name + "\" has no size"};
  }
  return AnchorTracker(std::make_unique<Impl>(anchor, options));
}

AnchorTracker::AnchorTracker(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
AnchorTracker::AnchorTracker(AnchorTracker&&) noexcept = default;
AnchorTracker& AnchorTracker::operator=(AnchorTracker&&) noexcept = default;
AnchorTracker::~AnchorTracker() = default;

std::optional<Roi> AnchorTracker::track(const uav::CameraSample& image) {
  if (!is_whole(image)) {
    reset();
    return std::nullopt;
  }
  prefilter(image);
  back_project();
  return locate();
}

void AnchorTracker::prefilter(const uav::CameraSample& image) {
  impl_->filter(image);
}

void AnchorTracker::back_project() {
  cv::cvtColor(impl_->smooth, impl_->hsv, cv::COLOR_RGB2HSV);
  impl_->color.back_project(impl_->hsv, impl_->probability);
  if (impl_->options.is_hollow) fill_openings(impl_->probability, impl_->options.min_area_px);
}

std::optional<Roi> AnchorTracker::locate() {
  std::optional<Roi> roi;
  if (impl_->window) roi = impl_->follow_window();
  if (!roi) roi = impl_->search();
  if (roi) {
    const Edges edges = find_edges(impl_->hsv, *impl_->window, impl_->color);
    roi->center = {0.5 * (edges.left_px + edges.right_px), 0.5 * (edges.top_px + edges.bottom_px)};
    roi->width_px = edges.right_px - edges.left_px;
    roi->height_px = edges.bottom_px - edges.top_px;
    roi->edge_height_px = edges.height_px;
  }
  return roi;
}

void AnchorTracker::reset() {
  impl_->window.reset();
}

}  // namespace tether::vision
