#include "image_warp.h"

#include <cmath>

#include <gtest/gtest.h>

namespace tether::sim {
namespace {

// An ideal image whose colour says where it was looked at: red and green are the direction's x and
// y at z = 1, from −2 to 2.
std::vector<std::uint8_t> direction_image(const uav::CameraModel& camera) {
  std::vector<std::uint8_t> rgb;
  for (int row = 0; row < camera.height_px; ++row) {
    for (int column = 0; column < camera.width_px; ++column) {
      const uav::Vec3 p = camera.unproject({static_cast<double>(column), static_cast<double>(row)});
      rgb.push_back(static_cast<std::uint8_t>(std::lround((p.x + 2.0) * 63.75)));
      rgb.push_back(static_cast<std::uint8_t>(std::lround((p.y + 2.0) * 63.75)));
      rgb.push_back(0);
    }
  }
  return rgb;
}

std::vector<std::uint8_t> white_image(const uav::CameraModel& camera) {
  return std::vector<std::uint8_t>(static_cast<std::size_t>(3 * camera.width_px * camera.height_px),
                                   255);
}

void expect_each_pixel_sees_its_direction(const uav::CameraModel& camera) {
  const ImageWarp warp(camera);
  EXPECT_FALSE(ImageWarp::is_needed(warp.source()));
  EXPECT_EQ(warp.blind_pixels(), 0U);
  const auto pixels = static_cast<std::size_t>(camera.width_px * camera.height_px);
  std::vector<std::uint8_t> rgb(3 * pixels);
  warp.apply(direction_image(warp.source()), rgb);
  for (std::size_t i = 0; i < pixels; i += 7) {
    const auto width = static_cast<std::size_t>(camera.width_px);
    const uav::Vec3 p =
        camera.unproject({static_cast<double>(i % width), static_cast<double>(i / width)});
    EXPECT_NEAR(rgb[3 * i], (p.x + 2.0) * 63.75, 1.1);
    EXPECT_NEAR(rgb[3 * i + 1], (p.y + 2.0) * 63.75, 1.1);
  }
}

TEST(ImageWarpTest, UndoesDistortion) {
  auto camera = uav::CameraModel::from_horizontal_fov(160, 120, 1.2);
  camera.k1 = -0.2;
  camera.k2 = 0.03;
  camera.k3 = -0.01;
  camera.p1 = 0.002;
  camera.p2 = -0.003;
  EXPECT_TRUE(ImageWarp::is_needed(camera));
  expect_each_pixel_sees_its_direction(camera);
}

// Beyond 46° off the axis this lens folds back: no direction maps to the corners.
TEST(ImageWarpTest, PixelsWithoutADirectionAreBlack) {
  auto camera = uav::CameraModel::from_horizontal_fov(160, 120, 1.4);
  camera.k1 = -0.3;
  const ImageWarp warp(camera);
  EXPECT_LE(warp.source().width_px, 2 * camera.width_px);
  std::vector<std::uint8_t> rgb(std::size_t{3} * 160 * 120);
  warp.apply(white_image(warp.source()), rgb);
  const double fold = std::sqrt(1.0 / 0.9);
  const double reach_px = camera.fx_px * fold * (1.0 - 0.3 * fold * fold);
  std::size_t black = 0;
  for (std::size_t i = 0; i < 160 * 120; ++i) {
    const double off_px = std::hypot(static_cast<double>(i % 160) - camera.cx_px,
                                     static_cast<double>(i / 160) - camera.cy_px);
    if (rgb[3 * i] == 0) ++black;
    if (std::abs(off_px - reach_px) < 0.5) continue;
    EXPECT_EQ(rgb[3 * i], off_px < reach_px ? 255 : 0) << i;
  }
  EXPECT_EQ(warp.blind_pixels(), black);
  EXPECT_GT(black, 1000U);
}

TEST(ImageWarpTest, ALensThatSeesNothingIsBlackAltogether) {
  auto camera = uav::CameraModel::from_horizontal_fov(16, 12, 1.4);
  camera.k1 = -1e6;
  camera.cx_px = 1e4;
  const ImageWarp warp(camera);
  EXPECT_EQ(warp.blind_pixels(), std::size_t{16} * 12);
  std::vector<std::uint8_t> rgb(std::size_t{3} * 16 * 12, 7);
  warp.apply(white_image(warp.source()), rgb);
  EXPECT_EQ(rgb, std::vector<std::uint8_t>(std::size_t{3} * 16 * 12, 0));
}

TEST(ImageWarpTest, OblongPixelsNeedOneButIdealCamerasDoNot) {
  auto camera = uav::CameraModel::from_horizontal_fov(160, 120, 1.2);
  EXPECT_FALSE(ImageWarp::is_needed(camera));
  camera.fy_px *= 1.5;
  camera.cx_px += 11.0;
  EXPECT_TRUE(ImageWarp::is_needed(camera));
  expect_each_pixel_sees_its_direction(camera);
}

}  // namespace
}  // namespace tether::sim
