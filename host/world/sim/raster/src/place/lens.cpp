#include "place/lens.h"

#include <algorithm>
#include <cmath>

#include <tether/base/error.h>

namespace tether::raster {
namespace {

constexpr double kFarthest_px = 32000.0;
constexpr int kCell_px = 4;  // of the smallest cells
constexpr int kCoarser = 4;  // from one level of cells to the next
constexpr int kManyCells = 4;

std::int32_t fixed_sample(double px) {
  if (!(std::abs(px) <= kFarthest_px)) {
    throw Error(ErrorCode::kUsage,
                "the camera sees more than 32000 pixels off its axis: use a smaller image, a "
                "narrower field of view, or distortion coefficients that hold for all of it");
  }
  return static_cast<std::int32_t>(std::floor(px * kSubpixels + 0.5));
}

std::size_t place_of(int column, int row, int columns) {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
         static_cast<std::size_t>(column);
}

int floor_div(int a, int b) {
  return a >= 0 ? a / b : -((b - 1 - a) / b);
}

}  // namespace

Lens::Lens(const uav::CameraModel& camera) : camera_(camera) {
  const auto blocks = static_cast<std::size_t>((camera.width_px + kStride - 1) / kStride);
  stride_ = blocks * kStride;
  if (!camera.has_distortion()) {
    all_ = {0, 0, (camera.width_px - 1) * kSubpixels, (camera.height_px - 1) * kSubpixels};
    return;
  }
  fill_samples();
  fill_cells();
}

void Lens::fill_samples() {
  const std::size_t count = stride_ * static_cast<std::size_t>(camera_.height_px);
  x_.assign(count, kBlind);
  y_.assign(count, kBlind);
  all_ = FixedRect::none();
  const uav::PixelRays rays(camera_);
  for (int row = 0; row < camera_.height_px; ++row) {
    for (int column = 0; column < camera_.width_px; ++column) {
      if (column % kStride == 0) blocks_.push_back(FixedRect::none());
      const std::size_t i =
          static_cast<std::size_t>(row) * stride_ + static_cast<std::size_t>(column);
      if (const auto p = rays.at({static_cast<double>(column), static_cast<double>(row)})) {
        x_[i] = fixed_sample(camera_.cx_px + camera_.fx_px * p->x);
        y_[i] = fixed_sample(camera_.cy_px + camera_.fy_px * p->y);
        all_.include({x_[i], y_[i], x_[i], y_[i]});
      } else {
        ++blind_pixels_;
      }
      blocks_.back().include({x_[i], y_[i], x_[i], y_[i]});
    }
  }
}

void Lens::fill_cells() {
  if (all_.is_empty()) return;
  // A lens that sees very far aside has no more cells than pixels.
  const auto pixels =
      static_cast<std::size_t>(camera_.width_px) * static_cast<std::size_t>(camera_.height_px);
  const auto wide = [](std::int32_t low, std::int32_t high, int size) {
    return static_cast<std::size_t>((high - low) / size) + 1;
  };
  int size = kCell_px * kSubpixels;
  while (wide(all_.x_low, all_.x_high, size) * wide(all_.y_low, all_.y_high, size) > pixels) {
    size *= 2;
  }
  Cells& finest = cells_[0];
  finest = empty_cells(size);
  for (int row = 0; row < camera_.height_px; ++row) {
    for (int column = 0; column < camera_.width_px; ++column) {
      const std::size_t i =
          static_cast<std::size_t>(row) * stride_ + static_cast<std::size_t>(column);
      if (x_[i] == kBlind) continue;
      finest.at((x_[i] - all_.x_low) / finest.size, (y_[i] - all_.y_low) / finest.size)
          .include({column, row, column, row});
    }
  }
  for (std::size_t level = 1; level < cells_.size(); ++level) {
    const Cells& finer = cells_[level - 1];
    Cells& cells = cells_[level];
    cells = empty_cells(kCoarser * finer.size);
    for (std::size_t i = 0; i < finer.pixels.size(); ++i) {
      const int column = static_cast<int>(i) % finer.columns;
      const int row = static_cast<int>(i) / finer.columns;
      cells.at(column / kCoarser, row / kCoarser).include(finer.pixels[i]);
    }
  }
}

Lens::Cells Lens::empty_cells(int size) const {
  const int columns = (all_.x_high - all_.x_low) / size + 1;
  const int rows = (all_.y_high - all_.y_low) / size + 1;
  return {size, columns, std::vector<PixelRect>(place_of(0, rows, columns), PixelRect::none())};
}

FixedRect Lens::samples_of(const PixelRect& pixels) const {
  if (is_grid()) {
    return {pixels.x_low * kSubpixels, pixels.y_low * kSubpixels, pixels.x_high * kSubpixels,
            pixels.y_high * kSubpixels};
  }
  FixedRect bounds = FixedRect::none();
  for (int row = pixels.y_low; row <= pixels.y_high; ++row) {
    for (int block = pixels.x_low / kStride; block <= pixels.x_high / kStride; ++block) {
      bounds.include(samples_of_block(block, row));
    }
  }
  return bounds;
}

FixedRect Lens::seen_part(const FixedRect& rect) const {
  const FixedRect seen = common_part(rect, all_);
  return seen.is_empty() ? rect : seen;
}

PixelRect Lens::pixels_of(const FixedRect& rect) const {
  const FixedRect seen = common_part(rect, all_);
  if (seen.is_empty()) return PixelRect::none();
  if (is_grid()) {
    return {(seen.x_low + kSubpixels - 1) / kSubpixels, (seen.y_low + kSubpixels - 1) / kSubpixels,
            floor_div(seen.x_high, kSubpixels), floor_div(seen.y_high, kSubpixels)};
  }
  std::size_t level = 0;
  const std::int32_t extent = std::max(seen.x_high - seen.x_low, seen.y_high - seen.y_low);
  while (level + 1 < cells_.size() && extent > kManyCells * cells_[level].size) ++level;
  const Cells& cells = cells_[level];
  PixelRect pixels = PixelRect::none();
  const int last_column = (seen.x_high - all_.x_low) / cells.size;
  const int last_row = (seen.y_high - all_.y_low) / cells.size;
  for (int row = (seen.y_low - all_.y_low) / cells.size; row <= last_row; ++row) {
    for (int c = (seen.x_low - all_.x_low) / cells.size; c <= last_column; ++c) {
      pixels.include(cells.pixels[place_of(c, row, cells.columns)]);
    }
  }
  return pixels;
}

}  // namespace tether::raster
