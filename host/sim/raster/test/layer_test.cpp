#include "place/layer.h"

#include "test_scenes.h"

#include <vector>

#include <gmock/gmock.h>

namespace tether::raster {
namespace {

using testing::ElementsAre;

Layer sheet() {
  const Scene scene(plain_parts(crumpled_sheet(1, 9, 5.0F), {1, 1, 1}));
  const Lens lens(small_camera());
  const uav::CameraModel& c = lens.camera();
  Layer layer;
  layer.projection = {c.fx_px, c.fy_px, c.cx_px, c.cy_px, 0.05};
  place_triangles(scene.prepared(), lens, {0, c.height_px}, {}, layer);
  return layer;
}

FixedRect rect(std::uint64_t seed) {
  const auto x = static_cast<std::int32_t>(drawn(seed, 0, 0, 150 * kSubpixels));
  const auto y = static_cast<std::int32_t>(drawn(seed, 1, 0, 110 * kSubpixels));
  return {x, y, x + static_cast<std::int32_t>(drawn(seed, 2, 0, 20 * kSubpixels)),
          y + static_cast<std::int32_t>(drawn(seed, 3, 0, 20 * kSubpixels))};
}

// Some points of a rectangle, its corners first.
std::vector<FixedRect> points(const FixedRect& r, std::uint64_t seed) {
  std::vector<FixedRect> all{{r.x_low, r.y_low, r.x_low, r.y_low},
                             {r.x_high, r.y_high, r.x_high, r.y_high}};
  for (std::uint64_t i = 0; i < 20; ++i) {
    const auto x = static_cast<std::int32_t>(drawn(seed, 10 + i, r.x_low, r.x_high + 1.0));
    const auto y = static_cast<std::int32_t>(drawn(seed, 40 + i, r.y_low, r.y_high + 1.0));
    all.push_back({x, y, x, y});
  }
  return all;
}

TEST(DepthRange, HoldsTheDepthsOfARectangle) {
  const Layer layer = sheet();
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const DepthPlane& depth = layer.coverage[seed % layer.coverage.size()].depth;
    const FixedRect whole = rect(seed);
    const DepthRange range = depth_range(depth, whole);
    for (const FixedRect& point : points(whole, seed)) {
      EXPECT_GE(depth_range(depth, point).low, range.low) << seed;
      EXPECT_LE(depth_range(depth, point).high, range.high) << seed;
    }
  }
}

TEST(Reach, TellsWhichEdgesPartARectangle) {
  const Layer layer = sheet();
  int without = 0;
  int within = 0;
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    const Coverage& triangle = layer.coverage[seed % layer.coverage.size()];
    const FixedRect whole = rect(seed);
    const Reach of_whole = reach(triangle, whole, 7U);
    without += of_whole.is_none ? 1 : 0;
    within += !of_whole.is_none && of_whole.edges == 0 ? 1 : 0;
    for (const FixedRect& point : points(whole, seed)) {
      const bool is_inside = !reach(triangle, point, 7U).is_none;
      EXPECT_FALSE(of_whole.is_none && is_inside) << seed;
      EXPECT_TRUE(of_whole.is_none || of_whole.edges != 0 || is_inside) << seed;
      // The edges that do not part it need not be looked at again.
      EXPECT_TRUE(of_whole.is_none || is_inside == !reach(triangle, point, of_whole.edges).is_none);
    }
  }
  EXPECT_GT(without, 100);
  EXPECT_GT(within, 10);
}

std::vector<Coverage> triangles(const std::vector<std::uint32_t>& primitives) {
  std::vector<Coverage> all;
  for (const std::uint32_t primitive : primitives) {
    all.emplace_back().primitive = primitive;
  }
  return all;
}

TEST(Keys, AreTheSameForATriangleInAllLayersThatShareItWithTheMiddle) {
  std::vector<Layer> layers(3);
  layers[0].coverage = triangles({1, 2, 7, 9});
  layers[1].coverage = triangles({2, 2, 4, 9});  // the first was cut in two
  layers[2].coverage = triangles({2, 7, 9, 9});
  set_keys(layers);
  EXPECT_THAT(layers[1].keys, ElementsAre(1, 1, 3, 4));
  const std::uint32_t first = layers[0].first_own_key;
  const std::uint32_t last = layers[2].first_own_key;
  EXPECT_THAT(layers[0].keys, ElementsAre(first, 1, first + 2, 4));
  EXPECT_THAT(layers[2].keys, ElementsAre(1, last + 1, 4, 4));
  EXPECT_GT(first, 4U) << "is no key of the middle";
  EXPECT_GE(last, first + 4) << "is no key of the first layer";
}

}  // namespace
}  // namespace tether::raster
