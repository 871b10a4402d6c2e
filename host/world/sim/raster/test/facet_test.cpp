#include "place/facet.h"

#include "test_scenes.h"

#include <cmath>

#include <gtest/gtest.h>

namespace tether::raster {
namespace {

// A rectangle at z = 2, turned about the y axis, whose texture runs from 0 to 1.
TEST(Facet, HasTheDepthAndTheTextureOfWhatARayMeets) {
  constexpr double kTurn_rad = 0.7;
  SceneParts parts = plain_parts(rectangle(-1, -1, 1, 1, 0), {1, 1, 1});
  parts.instances[0].X_BV = {{0.0, 0.0, 2.0}, uav::from_axis_angle({0.0, 1.0, 0.0}, kTurn_rad)};
  const Scene scene(parts);
  const Lens lens(small_camera());
  const uav::CameraModel& c = lens.camera();
  Layer layer;
  layer.projection = {c.fx_px, c.fy_px, c.cx_px, c.cy_px, 0.05};
  place_triangles(scene.prepared(), lens, {0, c.height_px}, {}, layer);
  ASSERT_EQ(layer.coverage.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    const Facet& facet = layer.facet(scene.prepared(), i);
    EXPECT_EQ(&facet, &layer.facet(scene.prepared(), i)) << "is made once";
    EXPECT_NE(facet.is_flat, 0);
    EXPECT_NEAR(std::abs(static_cast<double>(facet.normal[0][0])), std::sin(kTurn_rad), 1e-6);
    const PixelRect& pixels = layer.coverage[i].pixels;
    for (int x = pixels.x_low; x <= pixels.x_high; x += 7) {
      for (int y = pixels.y_low; y <= pixels.y_high; y += 5) {
        const double ray_x = (x - c.cx_px) / c.fx_px;
        const double ray_y = (y - c.cy_px) / c.fy_px;
        // (ray·z − (0, 0, 2))·normal = 0
        const double z =
            2.0 * std::cos(kTurn_rad) / (std::cos(kTurn_rad) + ray_x * std::sin(kTurn_rad));
        const double along = (ray_x * z) * std::cos(kTurn_rad) - (z - 2.0) * std::sin(kTurn_rad);
        if (std::abs(along) > 0.99 || std::abs(ray_y * z) > 0.99) continue;
        const double dx = x - static_cast<double>(facet.depth.x_ref);
        const double dy = y - static_cast<double>(facet.depth.y_ref);
        const auto at = [&](const std::array<float, 3>& plane) {
          return static_cast<double>(plane[0]) + static_cast<double>(plane[1]) * dx +
                 static_cast<double>(plane[2]) * dy;
        };
        EXPECT_NEAR(1.0 / at(facet.depth.plane), z, 1e-4);
        EXPECT_NEAR(static_cast<double>(facet.u.first) + z * at(facet.u.added), 0.5 * (along + 1.0),
                    1e-4);
        EXPECT_NEAR(static_cast<double>(facet.v.first) + z * at(facet.v.added),
                    0.5 * (ray_y * z + 1.0), 1e-4);
      }
    }
  }
}

TEST(Facet, IsConstantWhereATriangleIsSeenEdgeOn) {
  const Projection projection{100.0, 100.0, 50.0, 50.0, 0.05};
  const DepthPlane depth = depth_of({{{0, 0, 1}, {0, 0, 2}, {0, 0, 3}}}, projection,
                                    {0, 0, 100 * kSubpixels, 100 * kSubpixels});
  EXPECT_EQ(depth.plane, (std::array<float, 3>{depth.high, 0.0F, 0.0F}));
  EXPECT_FLOAT_EQ(depth.low, 1.0F / 3.0F);
}

}  // namespace
}  // namespace tether::raster
