#include "image_warp.h"

#include <cmath>

#include <gtest/gtest.h>

namespace tether::sim {
namespace {

// An ideal image whose colour says where it was looked at: red and green are the direction's x and
// y at z = 1, from −2 to 2.
RawImage direction_image(const uav::CameraModel& camera) {
  RawImage image{camera.width_px, camera.height_px, {}};
  for (int row = camera.height_px - 1; row >= 0; --row) {
    for (int column = 0; column < camera.width_px; ++column) {
      const uav::Vec3 p = camera.unproject({static_cast<double>(column), static_cast<double>(row)});
      const auto red = static_cast<std::uint32_t>(std::lround((p.x + 2.0) * 63.75));
      const auto green = static_cast<std::uint32_t>(std::lround((p.y + 2.0) * 63.75));
      image.rgba.push_back(red | (green << 8));
    }
  }
  return image;
}

void expect_each_pixel_sees_its_direction(const uav::CameraModel& camera) {
  const ImageWarp warp(camera);
  EXPECT_FALSE(ImageWarp::is_needed(warp.source()));
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

TEST(ImageWarpTest, DistortedCamera) {
  auto camera = uav::CameraModel::from_horizontal_fov(160, 120, 1.2);
  camera.k1 = -0.2;
  camera.k2 = 0.03;
  camera.p1 = 0.002;
  EXPECT_TRUE(ImageWarp::is_needed(camera));
  expect_each_pixel_sees_its_direction(camera);
}

TEST(ImageWarpTest, OblongPixels) {
  auto camera = uav::CameraModel::from_horizontal_fov(160, 120, 1.2);
  camera.fy_px *= 1.5;
  camera.cx_px += 11.0;
  EXPECT_TRUE(ImageWarp::is_needed(camera));
  expect_each_pixel_sees_its_direction(camera);
}

TEST(ImageWarpTest, IdealCameraNeedsNone) {
  EXPECT_FALSE(ImageWarp::is_needed(uav::CameraModel::from_horizontal_fov(640, 480, 1.0)));
}

}  // namespace
}  // namespace tether::sim
