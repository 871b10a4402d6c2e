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

TEST(InverseDepth, IsNowhereInARectangleMoreThanItsMost) {
  const Layer layer = sheet();
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const DepthPlane& depth = layer.coverage[seed % layer.coverage.size()].depth;
    const FixedRect whole = rect(seed);
    const float most = most_inverse_depth(depth, whole);
    for (const FixedRect& point : points(whole, seed)) {
      EXPECT_LE(most_inverse_depth(depth, point), most) << seed;
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

Layer layer_of(const std::vector<std::uint32_t>& primitives) {
  Layer layer;
  layer.visuals.push_back({{}, 0, 0, 77});
  for (const std::uint32_t primitive : primitives) {
    layer.coverage.emplace_back().primitive = primitive;
  }
  return layer;
}

TEST(Keys, AreTheSameForATriangleInAllLayers) {
  std::vector<Layer> layers{layer_of({1, 2, 7, 9}), layer_of({2, 2, 4, 9}), layer_of({2, 7, 9, 9})};
  std::vector<Primitive> primitives;
  set_keys(layers, primitives);
  EXPECT_THAT(layers[0].keys, ElementsAre(1, 2, 4, 5));
  EXPECT_THAT(layers[1].keys, ElementsAre(2, 2, 3, 5)) << "the first was cut in two";
  EXPECT_THAT(layers[2].keys, ElementsAre(2, 4, 5, 5));
  std::vector<std::uint32_t> numbers;
  for (const Primitive& primitive : primitives) {
    numbers.push_back(primitive.number);
    EXPECT_EQ(primitive.entity, 77U);
  }
  EXPECT_THAT(numbers, ElementsAre(1, 2, 4, 7, 9));
}

}  // namespace
}  // namespace tether::raster
