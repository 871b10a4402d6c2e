#include "place/clip.h"
#include "place/shadow_map.h"
#include "place/transform.h"
#include "strip_renderer.h"
#include "test_scenes.h"

#include <gmock/gmock.h>

namespace tether::raster {
namespace {

TEST(Clip, LeavesWhatIsBeyondTheNearPlane) {
  Polygon polygon;
  polygon.add({{0.0, 0.0, -1.0}, {0, 0}, false});
  polygon.add({{1.0, 0.0, 3.0}, {0, 0}, false});
  polygon.add({{-1.0, 0.5, 3.0}, {0, 0}, false});
  clip(polygon, {100.0, 100.0, 50.0, 50.0, 1.0});
  ASSERT_EQ(polygon.size, 4U);
  for (std::size_t i = 0; i < polygon.size; ++i) {
    EXPECT_GE(polygon.points[i].p_C.z, 1.0 - 1e-12);
  }
}

TEST(Clip, LeavesNothingOfWhatIsBehind) {
  Polygon polygon;
  for (int i = 0; i < 3; ++i) polygon.add({{1.0 * i, 1.0, -1.0 - i}, {0, 0}, false});
  clip(polygon, {100.0, 100.0, 50.0, 50.0, 1.0});
  EXPECT_LT(polygon.size, 3U);
}

}  // namespace
}  // namespace tether::raster
