#if defined(TETHER_RASTER_SURFACE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TETHER_RASTER_SURFACE_INL_H_
#undef TETHER_RASTER_SURFACE_INL_H_
#else
#define TETHER_RASTER_SURFACE_INL_H_
#endif

#include "layer.h"
#include "rasterize.h"
#include "vector-inl.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

// The surface of a triangle at several pixels.
HWY_BEFORE_NAMESPACE();
namespace tether::raster::HWY_NAMESPACE {
namespace {

// Where some pixels are in the undistorted picture, and the slopes of their rays.
struct Pixels {
  V x, y;
  V ray_x, ray_y;
};

// Pixels of a tile from `at` on, all in one row.
HWY_INLINE Pixels pixels_at(const Lens& lens, const Layer& layer, const Tile& tile,
                            std::size_t at) {
  const int column = tile.x + static_cast<int>(at % kTile_px);
  const int row = tile.y + static_cast<int>(at / kTile_px);
  Pixels p;
  if (lens.is_grid()) {
    p.x = Add(lane_numbers(), set(static_cast<float>(column)));
    p.y = set(static_cast<float>(row));
  } else {
    const std::size_t sample =
        static_cast<std::size_t>(row) * lens.stride() + static_cast<std::size_t>(column);
    const V scale = set(1.0F / kSubpixels);
    p.x = Mul(to_float(hn::LoadU(DI(), lens.x().data() + sample)), scale);
    p.y = Mul(to_float(hn::LoadU(DI(), lens.y().data() + sample)), scale);
  }
  p.x = Add(p.x, set(static_cast<float>(layer.offset_x_px)));
  p.y = Add(p.y, set(static_cast<float>(layer.offset_y_px)));
  const Projection& view = layer.projection;
  p.ray_x = Mul(Sub(p.x, set(static_cast<float>(view.cx))), set(static_cast<float>(1.0 / view.fx)));
  p.ray_y = Mul(Sub(p.y, set(static_cast<float>(view.cy))), set(static_cast<float>(1.0 / view.fy)));
  return p;
}

// Calls `use` with each triangle that some pixels see, with these pixels, and with whether it is
// the first.
template <class Use>
HWY_INLINE void for_each_facet(VU ids, const Use& use) {
  const DI di;
  const VI id = hn::BitCast(di, ids);
  auto rest = hn::Gt(id, whole(0));
  if (hn::AllFalse(di, rest)) return;
  alignas(64) std::array<std::int32_t, kMaxLanes> all;
  std::int32_t one = hn::GetLane(id);
  const auto take_next = [&](auto is_first) HWY_ATTR {
    const auto same = hn::Eq(id, whole(one));
    rest = hn::AndNot(same, rest);
    use(static_cast<std::size_t>(one - 1), same, is_first);
  };
  const auto find_next = [&]() HWY_ATTR {
    one = all[static_cast<std::size_t>(hn::FindFirstTrue(di, rest))];
  };
  if (one == 0) {
    hn::Store(id, di, all.data());
    find_next();
  }
  take_next(std::true_type());
  if (hn::AllFalse(di, rest)) return;
  hn::Store(id, di, all.data());
  do {
    find_next();
    take_next(std::false_type());
  } while (!hn::AllFalse(di, rest));
}

HWY_INLINE V plane(const std::array<float, 3>& p, V dx, V dy) {
  return Add(Add(set(p[0]), Mul(set(p[2]), dy)), Mul(set(p[1]), dx));
}

// Where on a triangle some pixels look: from its reference point in the picture, and the depth.
struct Spot {
  V dx, dy, z;
};

HWY_INLINE Spot spot(const Facet& f, const Pixels& p) {
  const V dx = Sub(p.x, set(f.x_ref));
  const V dy = Sub(p.y, set(f.y_ref));
  const V inverse = hn::Min(hn::Max(plane(f.inverse_depth, dx, dy), set(f.inverse_depth_low)),
                            set(f.inverse_depth_high));
  return {dx, dy, Div(set(1.0F), inverse)};
}

// The weights of the second and the third corner: within 0 and 1, for edges' sake.
struct Weights {
  V second, third;
};

HWY_INLINE Weights weights(const Facet& f, const Spot& s) {
  const auto weight = [&](const std::array<float, 3>& over_z) HWY_ATTR {
    return hn::Min(hn::Max(Mul(s.z, plane(over_z, s.dx, s.dy)), set(0.0F)), set(1.0F));
  };
  return {weight(f.second), weight(f.third)};
}

// Of the first corner, and what the others add to it.
HWY_INLINE V added(const std::array<float, 3>& corners, const Weights& w) {
  return Add(Mul(set(corners[1]), w.second), Mul(set(corners[2]), w.third));
}
HWY_INLINE V between_corners(const std::array<float, 3>& corners, const Weights& w) {
  return Add(set(corners[0]), added(corners, w));
}

struct Normal {
  V x, y, z;
};

HWY_INLINE Normal normal(const Facet& f, const Weights& w) {
  const V x = between_corners(f.normal[0], w);
  const V y = between_corners(f.normal[1], w);
  const V z = between_corners(f.normal[2], w);
  const V length2 = hn::Max(dot(x, y, z, x, y, z), set(1e-20F));
  const V scale = Div(set(1.0F), hn::Sqrt(length2));
  return {Mul(x, scale), Mul(y, scale), Mul(z, scale)};
}

// Some rows of a tile, step by step: each step goes over all pixels, a vector at a time. Pixels
// that see different triangles share a vector from the second step on.
struct Block {
  static constexpr int kRows = 8;
  static constexpr std::size_t kPixels = std::size_t{kRows} * kTile_px;
  template <class T>
  using Plane = std::array<T, kPixels>;

  // A vector with a triangle in it, from pixel `at` on.
  struct Vector {
    std::uint16_t at;
    bool is_shiny, is_textured;
  };

  alignas(64) Plane<std::uint32_t> ids;        // the input: 0 where nothing is to be shaded
  alignas(64) Plane<float> x, y, z;            // the surface's place in C
  alignas(64) Plane<float> nx, ny, nz;         // its normal
  alignas(64) Plane<float> u, v;               // in its texture
  alignas(64) Plane<float> texels_per_pixel2;  // of its largest size, squared; at least 1
  alignas(64) Plane<std::int32_t> level;       // rows of PreparedScene::levels: this, then the next
  alignas(64) Plane<std::int32_t> next_share;  // in 1/256
  alignas(64) Plane<std::int32_t> material;    // rows of PreparedScene::materials
  alignas(64) Plane<float> diffuse, specular;  // light that is not coloured yet
  alignas(64) Plane<float> r, g, b, alpha;     // the output
  std::array<Vector, kPixels> vectors;
  std::size_t vector_count;

  std::span<const Vector> active() const { return {vectors.data(), vector_count}; }
};

HWY_INLINE V load(const Block::Plane<float>& plane, std::size_t at) {
  return hn::Load(D(), plane.data() + at);
}
HWY_INLINE VI load(const Block::Plane<std::int32_t>& plane, std::size_t at) {
  return hn::Load(DI(), plane.data() + at);
}
HWY_INLINE void store(V value, Block::Plane<float>& plane, std::size_t at) {
  hn::Store(value, D(), plane.data() + at);
}

// A number of each pixel's material, and that of the first material.
HWY_INLINE V of_material(VI material, const float& of_first) {
  constexpr std::int32_t kFloats = sizeof(MaterialRow) / sizeof(float);
  const std::int32_t one = hn::GetLane(material);
  if (hn::AllTrue(DI(), hn::Eq(material, whole(one)))) return set((&of_first)[one * kFloats]);
  return hn::GatherIndex(D(), &of_first, Mul(material, whole(kFloats)));
}

}  // namespace
}  // namespace tether::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
