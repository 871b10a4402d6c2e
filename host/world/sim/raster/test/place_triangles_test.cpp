#include "place/lens.h"
#include "place/rasterize.h"
#include "scene/prepared_scene.h"
#include "test_scenes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <gtest/gtest.h>

namespace tether::raster {
namespace {

Layer placed(const Scene& scene, const Lens& lens) {
  Layer layer;
  const uav::CameraModel& c = lens.camera();
  layer.projection = {c.fx_px, c.fy_px, c.cx_px, c.cy_px, 0.05};
  layer.X_WB.resize(scene.bodies());
  place_triangles(scene.prepared(), lens, {0, c.height_px}, {}, layer);
  return layer;
}

// How many triangles cover each pixel.
std::vector<int> cover_counts(const Layer& layer, const Lens& lens) {
  const uav::CameraModel& c = lens.camera();
  std::vector<int> counts(static_cast<std::size_t>(c.width_px * c.height_px));
  const int across = tiles_across(lens);
  TileIds ids;
  for (std::size_t list = 0; list < layer.opaque.size(); ++list) {
    const Tile tile{static_cast<int>(list) % across * kTile_px,
                    static_cast<int>(list) / across * kTile_px, kTile_px, kTile_px};
    for (const std::uint32_t triangle : layer.opaque[list]) {
      ids.id.fill(0);
      ids.inverse_depth.fill(0.0F);
      rasterize_nearest(layer, lens, tile, {&triangle, 1}, Names::kPlaces, ids);
      for (std::size_t i = 0; i < kTilePixels; ++i) {
        const int x = tile.x + static_cast<int>(i % kTile_px);
        const int y = tile.y + static_cast<int>(i / kTile_px);
        if (ids.id[i] == 0 || x >= c.width_px || y >= c.height_px) continue;
        ++counts[static_cast<std::size_t>(y * c.width_px + x)];
      }
    }
  }
  return counts;
}

TEST(Rasterize, CoversEachPixelOfASheetOnce) {
  for (const uav::CameraModel& camera : {small_camera(), bent_camera()}) {
    const Lens lens(camera);
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
      const int n = 3 + static_cast<int>(seed) * 17;
      const Scene scene(plain_parts(crumpled_sheet(seed, n, 5.0F), {1, 1, 1}));
      const Layer layer = placed(scene, lens);
      std::size_t wrong = 0;
      for (const int count : cover_counts(layer, lens)) wrong += count == 1 ? 0 : 1;
      EXPECT_EQ(wrong, 0U) << "seed " << seed << ", distorted: " << !lens.is_grid();
    }
  }
}

// Of 80,000 triangles in 19,200 pixels.
TEST(PlaceTriangles, LeavesOutSmallTrianglesBetweenPixels) {
  const Lens lens(small_camera());
  const Scene scene(plain_parts(crumpled_sheet(1, 200, 5.0F), {1, 1, 1}));
  const Layer layer = placed(scene, lens);
  const std::vector<int> counts = cover_counts(layer, lens);
  EXPECT_EQ(std::ranges::count(counts, 1), 160 * 120);
  EXPECT_LE(layer.coverage.size(), 160U * 120U);
}

TEST(Rasterize, CoversEachPixelOnceBeforeTheNearPlaneAndFarBeyondThePicture) {
  // A floor that runs below the camera from behind it to the horizon, and 50 km to each side.
  Mesh floor;
  for (int i = 0; i <= 8; ++i) {
    for (int j = 0; j <= 1; ++j) {
      floor.vertices.push_back(
          {{static_cast<float>(12500 * (i - 4)), 1.5F, j == 0 ? -40000.0F : 60000.0F},
           {0.0F, -1.0F, 0.0F}});
    }
  }
  for (std::uint32_t i = 0; i < 16; i += 2) {
    floor.triangles.insert(floor.triangles.end(), {{i, i + 2, i + 3}, {i, i + 3, i + 1}});
  }
  const Scene scene(plain_parts(floor, {1, 1, 1}));
  const Lens lens(small_camera());
  const Layer layer = placed(scene, lens);
  const std::vector<int> counts = cover_counts(layer, lens);
  for (int row = 62; row < 120; ++row) {
    for (int column = 0; column < 160; ++column) {
      ASSERT_EQ(counts[static_cast<std::size_t>(row * 160 + column)], 1)
          << "column " << column << ", row " << row;
    }
  }
}

// How far along a ray a triangle is hit from the front, found the slow way.
std::optional<double> hit(const uav::Vec3& ray, const std::array<uav::Vec3, 3>& t) {
  const uav::Vec3 n = cross(t[1] - t[0], t[2] - t[0]);
  if (dot(n, ray) >= 0.0) return std::nullopt;
  const double z = dot(n, t[0]) / dot(n, ray);
  for (std::size_t i = 0; i < 3; ++i) {
    const uav::Vec3& from = t[i];
    if (dot(n, cross(t[(i + 1) % 3] - from, z * ray - from)) < 0.0) return std::nullopt;
  }
  return z;
}

using Triangles = std::vector<std::array<uav::Vec3, 3>>;

// The nearest hit of a pixel; none if it depends on where in the pixel's middle the ray goes.
std::optional<double> depth_at(const uav::CameraModel& camera, double column, double row,
                               const Triangles& triangles) {
  constexpr double kMiddle_px = 0.01;
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& triangle : triangles) {
    int hits = 0;
    double z = 0.0;
    for (int i = 0; i < 5; ++i) {
      const double du = i == 1 ? kMiddle_px : i == 2 ? -kMiddle_px : 0.0;
      const double dv = i == 3 ? kMiddle_px : i == 4 ? -kMiddle_px : 0.0;
      const auto found = hit(camera.unproject({column + du, row + dv}), triangle);
      hits += found ? 1 : 0;
      if (i == 0) z = found.value_or(0.0);
    }
    if (hits % 5 != 0) return std::nullopt;
    if (hits == 5) nearest = std::min(nearest, z);
  }
  return nearest;
}

Triangles random_triangles(std::uint64_t seed) {
  Triangles triangles(100);
  std::uint64_t i = 0;
  for (auto& triangle : triangles) {
    for (uav::Vec3& p : triangle) {
      // As floats have them.
      const auto at = [&](double low, double high) {
        return static_cast<double>(static_cast<float>(drawn(seed, i++, low, high)));
      };
      p.x = at(-3, 3);
      p.y = at(-3, 3);
      p.z = at(1, 8);
    }
  }
  return triangles;
}

Mesh mesh_of(const Triangles& triangles) {
  Mesh mesh;
  for (const auto& triangle : triangles) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.triangles.push_back({first, first + 1, first + 2});
    for (const uav::Vec3& p : triangle) {
      mesh.vertices.push_back(
          {{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)},
           {0.0F, 0.0F, -1.0F}});
    }
  }
  return mesh;
}

TEST(Rasterize, AgreesWithRaysThroughPixelCentres) {
  for (const uav::CameraModel& camera : {small_camera(48, 36), bent_camera(48, 36)}) {
    for (std::uint64_t seed = 0; seed < 2; ++seed) {
      const Triangles triangles = random_triangles(seed);
      const Drawing drawing = draw(Scene(plain_parts(mesh_of(triangles), {1, 1, 1})), camera);
      int compared = 0;
      for (int i = 0; i < 48 * 36; ++i) {
        const auto expected = depth_at(camera, i % 48, static_cast<double>(i / 48), triangles);
        if (!expected) continue;
        ++compared;
        const float depth = drawing.depth_m[static_cast<std::size_t>(i)];
        if (std::isinf(*expected)) {
          ASSERT_TRUE(std::isinf(depth)) << "pixel " << i << ", seed " << seed;
        } else {
          ASSERT_NEAR(depth, *expected, 2e-2 * *expected) << "pixel " << i << ", seed " << seed;
        }
      }
      EXPECT_GT(compared, 1000);
    }
  }
}

TEST(Rasterize, TakesTheFirstOfEquallyNearTriangles) {
  SceneParts parts = plain_parts(rectangle(-9, -9, 9, 9, 5), {1, 1, 1});
  parts.instances.push_back(parts.instances[0]);
  parts.instances[1].entity = 8;
  const Drawing drawing = draw(Scene(parts), small_camera());
  for (const std::uint32_t entity : drawing.entity) ASSERT_EQ(entity, 7U);
}

TEST(Rasterize, ShowsNoBackFaces) {
  SceneParts parts = plain_parts(rectangle(9, -9, -9, 9, 5), {1, 1, 1});
  const Drawing drawing = draw(Scene(parts), small_camera());
  for (const std::uint32_t entity : drawing.entity) ASSERT_EQ(entity, 0U);
}

}  // namespace
}  // namespace tether::raster
