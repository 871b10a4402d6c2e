#include "place/layer.h"

#include "place/facet.h"

#include <algorithm>
#include <array>
#include <iterator>

namespace tether::raster {

Reach reach(const Coverage& triangle, const FixedRect& rect, unsigned edges) {
  Reach result{false, 0};
  for (std::size_t i = 0; i < 3; ++i) {
    if ((edges >> i & 1U) == 0) continue;
    const std::int64_t a = triangle.a[i];
    const std::int64_t b = triangle.b[i];
    const auto x = std::minmax({a * rect.x_low, a * rect.x_high});
    const auto y = std::minmax({b * rect.y_low, b * rect.y_high});
    if (x.second + y.second + triangle.c[i] < 0) return {true, 0};
    if (x.first + y.first + triangle.c[i] < 0) result.edges |= 1U << i;
  }
  return result;
}

// Each operation is monotonic, so that it is at a corner. Beyond the depths of its own corners the
// plane of a triangle that is seen nearly edge-on overshoots.
float most_inverse_depth(const DepthPlane& depth, const FixedRect& rect) {
  const auto at = [&](std::int32_t x, std::int32_t y) {
    const float dx = static_cast<float>(x) / kSubpixels - depth.x_ref;
    const float dy = static_cast<float>(y) / kSubpixels - depth.y_ref;
    const auto& p = depth.plane;
    return std::clamp((p[0] + p[2] * dy) + p[1] * dx, depth.low, depth.high);
  };
  return std::max({at(rect.x_low, rect.y_low), at(rect.x_high, rect.y_low),
                   at(rect.x_low, rect.y_high), at(rect.x_high, rect.y_high)});
}

const Facet& Layer::facet(const PreparedScene& scene, std::size_t triangle) const {
  std::uint32_t& place = facet_of_[triangle];
  if (place == 0) {
    facets_.push_back(make_facet(scene, *this, coverage[triangle]));
    place = static_cast<std::uint32_t>(facets_.size());
  }
  return facets_[place - 1];
}

void Layer::clear_facets() {
  facet_of_.assign(coverage.size(), 0);
  facets_.clear();
  facets_.reserve(coverage.size());  // what is referred to stays where it is
}

void set_keys(std::span<Layer> layers, std::vector<Primitive>& primitives) {
  primitives.clear();
  std::vector<Primitive> own;
  std::vector<Primitive> all;
  for (const Layer& layer : layers) {
    own.clear();
    for (const Coverage& triangle : layer.coverage) {
      if (!own.empty() && own.back().number == triangle.primitive) continue;
      own.push_back({triangle.primitive, layer.visuals[triangle.visual].entity});
    }
    all.clear();
    std::ranges::set_union(primitives, own, std::back_inserter(all), {}, &Primitive::number,
                           &Primitive::number);
    primitives.swap(all);
  }
  for (Layer& layer : layers) {
    layer.keys.clear();
    std::uint32_t place = 0;
    for (const Coverage& triangle : layer.coverage) {
      while (primitives[place].number != triangle.primitive) ++place;
      layer.keys.push_back(place + 1);
    }
  }
}

}  // namespace tether::raster
