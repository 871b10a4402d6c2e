#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <tether/uav/camera_model.h>

namespace tether::raster {

/// Positions in the picture that the camera would take without distortion are whole numbers of
/// this part of a pixel, counted from the centre of the upper left pixel.
inline constexpr int kSubpixels = 256;
/// Positions beyond this are cut off, so that products of two fit where they are computed.
inline constexpr std::int32_t kGuard = (1 << 23) - 1;

/// Both ends included; empty if low > high.
template <class T>
struct Rect {
  T x_low, y_low, x_high, y_high;
  bool is_empty() const { return x_low > x_high || y_low > y_high; }
  void include(const Rect& more) {
    x_low = std::min(x_low, more.x_low);
    y_low = std::min(y_low, more.y_low);
    x_high = std::max(x_high, more.x_high);
    y_high = std::max(y_high, more.y_high);
  }
  static constexpr Rect none() {
    constexpr T kLow = std::numeric_limits<T>::min();
    constexpr T kHigh = std::numeric_limits<T>::max();
    return {kHigh, kHigh, kLow, kLow};
  }
};
template <class T>
Rect<T> common_part(const Rect<T>& a, const Rect<T>& b) {
  return {std::max(a.x_low, b.x_low), std::max(a.y_low, b.y_low), std::min(a.x_high, b.x_high),
          std::min(a.y_high, b.y_high)};
}
using PixelRect = Rect<int>;
using FixedRect = Rect<std::int32_t>;  ///< in kSubpixels

/// Where the centre of each pixel lies in the picture without distortion: the ray of a pixel is
/// that of this place.
class Lens {
 public:
  static constexpr int kStride = 32;  ///< the samples' rows are this wide, or a multiple
  static constexpr std::int32_t kBlind = -(1 << 30);

  /// @throws Error(kUsage) for a camera that sees beyond kGuard.
  explicit Lens(const uav::CameraModel& camera);

  const uav::CameraModel& camera() const { return camera_; }
  /// Whether pixel (i, j) is just at (i, j) · kSubpixels. There are no tables then.
  bool is_grid() const { return x_.empty(); }
  std::size_t stride() const { return stride_; }
  /// height × stride, kBlind where the lens maps no direction to the pixel.
  const std::vector<std::int32_t>& x() const { return x_; }
  const std::vector<std::int32_t>& y() const { return y_; }
  std::size_t blind_pixels() const { return blind_pixels_; }

  /// The bounds of the samples of kStride pixels of a row. @pre !is_grid()
  const FixedRect& samples_of_block(int block, int row) const {
    return blocks_[static_cast<std::size_t>(row) * (stride_ / kStride) +
                   static_cast<std::size_t>(block)];
  }
  /// The bounds of the samples of some pixels; of all of their blocks, if there is no grid.
  FixedRect samples_of(const PixelRect& pixels) const;
  /// The part of `rect` within the bounds of all samples; `rect` itself if there is none.
  FixedRect seen_part(const FixedRect& rect) const;
  /// The pixels whose samples may lie within `rect`: no other's does.
  PixelRect pixels_of(const FixedRect& rect) const;

 private:
  // For each square of the undistorted picture, the pixels whose samples lie in it.
  struct Cells {
    int size = 0;  // in kSubpixels
    int columns = 0;
    std::vector<PixelRect> pixels;

    PixelRect& at(int column, int row) {
      return pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                    static_cast<std::size_t>(column)];
    }
  };

  void fill_samples();
  void fill_cells();
  Cells empty_cells(int size) const;

  uav::CameraModel camera_;
  std::size_t stride_ = 0;
  std::vector<std::int32_t> x_;
  std::vector<std::int32_t> y_;
  std::vector<FixedRect> blocks_;  // of kStride pixels; kBlind counts
  FixedRect all_{};
  std::size_t blind_pixels_ = 0;
  std::array<Cells, 5> cells_;  ///< from fine to coarse
};

}  // namespace tether::raster
