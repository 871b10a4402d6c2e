#include "place/lens.h"

#include "test_scenes.h"

#include <cmath>

#include <gtest/gtest.h>

namespace tether::raster {
namespace {

TEST(Lens, LooksAlongTheRayOfEachPixel) {
  const uav::CameraModel camera = bent_camera();
  const Lens lens(camera);
  ASSERT_FALSE(lens.is_grid());
  EXPECT_EQ(lens.blind_pixels(), 0U);
  for (int row = 0; row < camera.height_px; ++row) {
    for (int column = 0; column < camera.width_px; ++column) {
      const std::size_t i =
          static_cast<std::size_t>(row) * lens.stride() + static_cast<std::size_t>(column);
      const uav::Vec3 seen{(lens.x()[i] / 256.0 - camera.cx_px) / camera.fx_px,
                           (lens.y()[i] / 256.0 - camera.cy_px) / camera.fy_px, 1.0};
      const uav::Pixel pixel = *camera.project(seen);
      ASSERT_NEAR(pixel.u_px, column, 4e-3);
      ASSERT_NEAR(pixel.v_px, row, 4e-3);
    }
  }
}

TEST(Lens, FindsAllPixelsOfAnyRectangle) {
  for (const uav::CameraModel& camera : {small_camera(), bent_camera()}) {
    const Lens lens(camera);
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
      const auto at = [&](std::uint64_t k, double high) {
        return static_cast<std::int32_t>(drawn(seed, k, -0.3 * high, high)) * kSubpixels;
      };
      const std::int32_t x = at(0, 160);
      const std::int32_t y = at(1, 120);
      const FixedRect rect{x, y, x + std::abs(at(2, 90)), y + std::abs(at(3, 30))};
      const PixelRect pixels = lens.pixels_of(rect);
      for (int row = 0; row < camera.height_px; ++row) {
        for (int column = 0; column < camera.width_px; ++column) {
          const std::size_t i =
              static_cast<std::size_t>(row) * lens.stride() + static_cast<std::size_t>(column);
          const std::int32_t sx = lens.is_grid() ? column * kSubpixels : lens.x()[i];
          const std::int32_t sy = lens.is_grid() ? row * kSubpixels : lens.y()[i];
          if (sx < rect.x_low || sx > rect.x_high || sy < rect.y_low || sy > rect.y_high) continue;
          ASSERT_TRUE(column >= pixels.x_low && column <= pixels.x_high && row >= pixels.y_low &&
                      row <= pixels.y_high);
        }
      }
    }
  }
}

TEST(Lens, CountsPixelsThatSeeNothingAndDrawsThemBlack) {
  uav::CameraModel camera = small_camera();
  camera.k1 = -0.9;
  SceneParts parts = plain_parts(rectangle(-30, -30, 30, 30, 5), {1, 1, 1});
  const Scene scene(parts);
  Renderer renderer(scene);
  EXPECT_GT(renderer.blind_pixels(camera), 100U);
  const Drawing drawing = draw(scene, camera);
  EXPECT_EQ(drawing.at(0, 0), (std::vector<int>{0, 0, 0}));
  EXPECT_TRUE(std::isnan(drawing.depth_m[0]));
  EXPECT_EQ(drawing.at(80, 60), (std::vector<int>{255, 255, 255}));
}

}  // namespace
}  // namespace tether::raster
