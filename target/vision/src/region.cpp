#include "region.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <opencv2/imgproc.hpp>

// Geometry of the tracked region in the probability map: candidates by connected components, a
// rectangle that is fitted to the mass, its score by shape, fill and colour, and its edges to a
// fraction of a pixel.
namespace tether::vision {
namespace {

/// A row or column belongs to the region where its mass is this share of the fullest one's.
constexpr double kProfileShare = 0.2;
/// Below this probability a pixel starts no region.
constexpr double kBlobThreshold = 48.0;
/// How far smoothing spreads an edge [px].
constexpr int kFade_px = 4;

cv::Rect inflated(const cv::Rect& r, int by, const cv::Size& image) {
  return cv::Rect(r.x - by, r.y - by, r.width + 2 * by, r.height + 2 * by) &
         cv::Rect({0, 0}, image);
}

/// [first, last] of the run of `profile` around its maximum that stays above the share.
cv::Range run_around_peak(const std::vector<float>& profile) {
  const auto peak = std::max_element(profile.begin(), profile.end());
  const auto least = static_cast<float>(kProfileShare) * *peak;
  const auto below = [least](float mass) { return mass < least; };
  const auto last = std::find_if(peak, profile.end(), below);
  const auto first = std::find_if(std::make_reverse_iterator(peak), profile.rend(), below).base();
  return {static_cast<int>(first - profile.begin()), static_cast<int>(last - profile.begin())};
}

enum class Along { kRows = 0, kColumns = 1 };

std::vector<float> profile_of(const cv::Mat& mass, Along along) {
  cv::Mat sums;
  cv::reduce(mass, sums, along == Along::kColumns ? 0 : 1, cv::REDUCE_SUM, CV_32F);
  return {sums.begin<float>(), sums.end<float>()};
}

double fit_of(double value, double least, double most) {
  return std::min({1.0, value / least, most / value});
}

double score_of(const cv::Mat& mass, const Roi& roi, const Proportions& expected) {
  const int count = cv::countNonZero(mass);
  if (count == 0) return 0.0;
  const double color = cv::sum(mass)[0] / (255.0 * count);
  const double fill = count / (roi.width_px * roi.height_px);
  // What is cut off by a border may look narrower or lower than it is.
  const double least = roi.cut_left_or_right ? 0.0 : expected.min_width_per_height;
  const double most = roi.cut_above_or_below ? 1e9 : expected.max_width_per_height;
  const double shape = fit_of(roi.width_px / roi.height_px, std::max(least, 1e-9), most);
  return color * std::min(1.0, fill / expected.fill) * shape;
}

/// Saturation × value of the pixels that have the anchor's hue, 0 elsewhere.
cv::Mat chroma_of(const cv::Mat& hsv, const ColorModel& color) {
  cv::Mat chroma(hsv.size(), CV_32F);
  for (int v = 0; v < hsv.rows; ++v) {
    for (int u = 0; u < hsv.cols; ++u) {
      const auto& pixel = hsv.at<cv::Vec3b>(v, u);
      const bool is_of_anchor = color.weight_of_hue(pixel[0]) > 0.0;
      chroma.at<float>(v, u) = is_of_anchor ? static_cast<float>(pixel[1] * pixel[2]) : 0.0F;
    }
  }
  return chroma;
}

template <class T>
T median(std::vector<T> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Median over the columns of: chroma of the whole column, in units of its middle's mean.
double column_height_px(const cv::Mat& chroma, const cv::Rect& inner) {
  const cv::Range middle(inner.y + inner.height / 4, inner.br().y - inner.height / 4);
  std::vector<double> heights;
  for (int u = inner.x; u < inner.br().x; ++u) {
    const double all = cv::sum(chroma.col(u))[0];
    const double within = cv::sum(chroma.col(u).rowRange(middle))[0];
    if (within > 0.0) heights.push_back(all * middle.size() / within);
  }
  return heights.empty() ? inner.height : median(std::move(heights));
}

/// Where `profile` rises to half of the level behind the edge near `first`, between samples; −0.5
/// where it has risen from the start.
double rising_edge(const std::vector<float>& profile, int first, int width) {
  const auto begin = profile.begin() + first;
  const float half = 0.5F * median(std::vector<float>(begin, begin + (width + 1) / 2));
  const auto high =
      std::find_if(profile.begin(), profile.end(), [half](float value) { return value >= half; });
  if (high == profile.begin() || high == profile.end()) return -0.5;
  const float low = *(high - 1);
  return static_cast<double>(high - profile.begin()) - (*high - half) / (*high - low);
}

struct Span {
  double first = 0.0;
  double last = 0.0;
};

/// Both edges of what lies near [first, first + width) of `profile`.
Span span_of(std::vector<float> profile, int first, int width) {
  const int count = static_cast<int>(profile.size());
  const double rise = rising_edge(profile, first, width);
  std::reverse(profile.begin(), profile.end());
  return {rise, count - 1 - rising_edge(profile, count - first - width, width)};
}

}  // namespace

Proportions proportions_of(const uav::Anchor& anchor) {
  // Room for a look from above, where the top adds to the height, and for blurred edges.
  constexpr double kNarrower = 0.7;
  constexpr double kWider = 1.2;
  const uav::Vec3& size = anchor.size_m;
  switch (anchor.shape) {
    case uav::AnchorShape::kCylinder:
      return {kNarrower * size.x / size.z, kWider * size.x / size.z, 0.8};
    case uav::AnchorShape::kSphere:
      return {kNarrower, kWider, 0.7};
    case uav::AnchorShape::kBox:
      break;
  }
  return {kNarrower * std::min(size.x, size.y) / size.z,
          kWider * std::hypot(size.x, size.y) / size.z, 0.8};
}

std::optional<cv::Rect> fit_rectangle(const cv::Mat& probability, const cv::Rect& window) {
  constexpr int kMaxRounds = 4;
  cv::Rect fitted = window;
  for (int round = 0; round < kMaxRounds; ++round) {
    const int margin = 4 + std::max(fitted.width, fitted.height) / 4;
    const cv::Rect area = inflated(fitted, margin, probability.size());
    if (area.empty() || cv::countNonZero(probability(area)) == 0) return std::nullopt;
    const cv::Range columns = run_around_peak(profile_of(probability(area), Along::kColumns));
    const cv::Mat upright = probability(area).colRange(columns);
    const cv::Range rows = run_around_peak(profile_of(upright, Along::kRows));
    const cv::Rect next(area.x + columns.start, area.y + rows.start, columns.size(), rows.size());
    if (next == fitted) break;
    fitted = next;
  }
  return fitted;
}

Roi measure(const cv::Mat& probability, const cv::Rect& rectangle, const Proportions& proportions) {
  const cv::Mat mass = probability(rectangle);
  const cv::Moments m = cv::moments(mass);
  Roi roi;
  roi.center = {rectangle.x + m.m10 / m.m00, rectangle.y + m.m01 / m.m00};
  roi.width_px = rectangle.width;
  roi.height_px = rectangle.height;
  roi.cut_left_or_right = rectangle.x <= 0 || rectangle.br().x >= probability.cols;
  roi.cut_above_or_below = rectangle.y <= 0 || rectangle.br().y >= probability.rows;
  roi.score = score_of(mass, roi, proportions);
  return roi;
}

Edges find_edges(const cv::Mat& hsv, const cv::Rect& rectangle, const ColorModel& color) {
  const cv::Rect area = inflated(rectangle, kFade_px, hsv.size());
  const cv::Mat chroma = chroma_of(hsv(area), color);
  const cv::Rect inner = rectangle - area.tl();

  const Span across = span_of(profile_of(chroma, Along::kColumns), inner.x, inner.width);
  const Span down = span_of(profile_of(chroma, Along::kRows), inner.y, inner.height);
  return {.left_px = area.x + across.first,
          .right_px = area.x + across.last,
          .top_px = area.y + down.first,
          .bottom_px = area.y + down.last,
          .height_px = column_height_px(chroma, inner)};
}

void fill_openings(cv::Mat& probability, int min_area_px) {
  cv::Mat likely;
  cv::threshold(probability, likely, kBlobThreshold, 255, cv::THRESH_BINARY);
  std::vector<std::vector<cv::Point>> outlines;
  cv::findContours(likely, outlines, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_SIMPLE);
  for (const std::vector<cv::Point>& outline : outlines) {
    if (cv::boundingRect(outline).area() < min_area_px) continue;
    // Of one that the border of the image cuts off, the outline goes around its opening, too.
    std::vector<cv::Point> hull;
    cv::convexHull(outline, hull);
    cv::fillConvexPoly(probability, hull, 255);
  }
}

std::vector<cv::Rect> find_blobs(const cv::Mat& probability, int min_area_px, std::size_t limit) {
  cv::Mat likely, labels, stats, centroids;
  cv::threshold(probability, likely, kBlobThreshold, 255, cv::THRESH_BINARY);
  cv::morphologyEx(likely, likely, cv::MORPH_OPEN,
                   cv::getStructuringElement(cv::MORPH_RECT, {3, 3}));
  const int count = cv::connectedComponentsWithStats(likely, labels, stats, centroids, 8);

  std::vector<int> blobs;
  for (int label = 1; label < count; ++label) {
    if (stats.at<int>(label, cv::CC_STAT_AREA) >= min_area_px) blobs.push_back(label);
  }
  std::stable_sort(blobs.begin(), blobs.end(), [&stats](int a, int b) {
    return stats.at<int>(a, cv::CC_STAT_AREA) > stats.at<int>(b, cv::CC_STAT_AREA);
  });
  blobs.resize(std::min(blobs.size(), limit));

  std::vector<cv::Rect> rectangles;
  for (const int label : blobs) {
    rectangles.emplace_back(
        stats.at<int>(label, cv::CC_STAT_LEFT), stats.at<int>(label, cv::CC_STAT_TOP),
        stats.at<int>(label, cv::CC_STAT_WIDTH), stats.at<int>(label, cv::CC_STAT_HEIGHT));
  }
  return rectangles;
}

}  // namespace tether::vision
