#include <cassert>
#include <cmath>
#include <numbers>

#include <tether/sim/bodies.h>

namespace tether::sim {
namespace {

constexpr int kRings = 4;
constexpr int kRaysOfFirstRing = 6;

}  // namespace

std::vector<uav::Vec3> cone_of_rays(double field_of_view_rad) {
  assert(field_of_view_rad >= 0.0 && field_of_view_rad <= std::numbers::pi);
  std::vector<uav::Vec3> rays{{1.0, 0.0, 0.0}};
  if (field_of_view_rad == 0.0) return rays;
  for (int ring = 1; ring <= kRings; ++ring) {
    const double off_axis_rad = 0.5 * field_of_view_rad * ring / kRings;
    const int count = kRaysOfFirstRing * ring;
    for (int i = 0; i < count; ++i) {
      const double around_rad = 2.0 * std::numbers::pi * i / count;
      rays.push_back({std::cos(off_axis_rad), std::sin(off_axis_rad) * std::cos(around_rad),
                      std::sin(off_axis_rad) * std::sin(around_rad)});
    }
  }
  return rays;
}

}  // namespace tether::sim
