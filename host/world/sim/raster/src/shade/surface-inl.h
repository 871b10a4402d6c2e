#if defined(TETHER_RASTER_SURFACE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TETHER_RASTER_SURFACE_INL_H_
#undef TETHER_RASTER_SURFACE_INL_H_
#else
#define TETHER_RASTER_SURFACE_INL_H_
#endif

#include "place/layer.h"
#include "place/rasterize.h"
#include "shade/shade.h"
#include "vector-inl.h"

#include <array>
#include <cstddef>
#include <cstdint>

// The surface of a triangle at several pixels.
HWY_BEFORE_NAMESPACE();
namespace tether::raster::HWY_NAMESPACE {
namespace {

// A tile of a layer, to be shaded.
struct LayerTile {
  const Shading& shading;
  const Layer& layer;
  const Tile& tile;
};

// The pixels of a vector: neighbours in a row of the tile, or any of its pixels, of which some may
// be the same.
struct Place {
  std::size_t first;           // of the neighbours
  const std::int32_t* places;  // of each pixel; null for neighbours
};

// The numbers of a tile's pixels in a vector.
template <class T>
HWY_INLINE auto load(const T* plane, const Place& at) {
  const hn::Rebind<T, D> d;
  if (at.places == nullptr) return hn::LoadU(d, plane + at.first);
  return hn::GatherIndex(d, plane, hn::Load(DI(), at.places));
}
template <class T, class Vector>
HWY_INLINE void store(Vector numbers, T* plane, const Place& at) {
  const hn::Rebind<T, D> d;
  if (at.places == nullptr) {
    hn::StoreU(numbers, d, plane + at.first);
  } else {
    hn::ScatterIndex(numbers, d, plane, hn::Load(DI(), at.places));
  }
}

// Where some pixels are in the undistorted picture, and the slopes of their rays.
struct Pixels {
  V x, y;
  V ray_x, ray_y;
};

// Where the pixels of a tile look. A copy of what it takes: nothing that is stored can change it.
class Sight {
 public:
  explicit Sight(const LayerTile& on)
      : lens_(on.shading.lens),
        is_grid_(lens_.is_grid()),
        x_(on.tile.x),
        y_(on.tile.y),
        offset_x_(static_cast<float>(on.layer.offset_x_px)),
        offset_y_(static_cast<float>(on.layer.offset_y_px)),
        cx_(static_cast<float>(on.layer.projection.cx)),
        cy_(static_cast<float>(on.layer.projection.cy)),
        per_fx_(static_cast<float>(1.0 / on.layer.projection.fx)),
        per_fy_(static_cast<float>(1.0 / on.layer.projection.fy)) {}

  HWY_INLINE Pixels pixels(const Place& at) const {
    Pixels p = at.places == nullptr ? neighbours(at.first) : any(hn::Load(DI(), at.places));
    p.x = Add(p.x, set(offset_x_));
    p.y = Add(p.y, set(offset_y_));
    p.ray_x = Mul(Sub(p.x, set(cx_)), set(per_fx_));
    p.ray_y = Mul(Sub(p.y, set(cy_)), set(per_fy_));
    return p;
  }

 private:
  HWY_INLINE Pixels neighbours(std::size_t at) const {
    const int column = x_ + static_cast<int>(at % kTile_px);
    const int row = y_ + static_cast<int>(at / kTile_px);
    Pixels p;
    if (is_grid_) {
      p.x = Add(lane_numbers(), set(static_cast<float>(column)));
      p.y = set(static_cast<float>(row));
    } else {
      const std::size_t sample =
          static_cast<std::size_t>(row) * lens_.stride() + static_cast<std::size_t>(column);
      p.x = in_pixels(hn::LoadU(DI(), lens_.x().data() + sample));
      p.y = in_pixels(hn::LoadU(DI(), lens_.y().data() + sample));
    }
    return p;
  }
  HWY_INLINE Pixels any(VI at) const {
    static_assert(kTile_px == 32);
    const VI column = Add(And(at, whole(31)), whole(x_));
    const VI row = Add(hn::ShiftRight<5>(at), whole(y_));
    Pixels p;
    if (is_grid_) {
      p.x = to_float(column);
      p.y = to_float(row);
    } else {
      const VI sample = Add(Mul(row, whole(static_cast<std::int32_t>(lens_.stride()))), column);
      p.x = in_pixels(hn::GatherIndex(DI(), lens_.x().data(), sample));
      p.y = in_pixels(hn::GatherIndex(DI(), lens_.y().data(), sample));
    }
    return p;
  }
  static HWY_INLINE V in_pixels(VI samples) {
    return Mul(to_float(samples), set(1.0F / kSubpixels));
  }

  const Lens& lens_;
  bool is_grid_;
  int x_, y_;
  float offset_x_, offset_y_, cx_, cy_, per_fx_, per_fy_;
};

HWY_INLINE V plane(const std::array<float, 3>& p, V dx, V dy) {
  return Add(Add(set(p[0]), Mul(set(p[2]), dy)), Mul(set(p[1]), dx));
}

// Where on a triangle some pixels look: from its reference point in the picture, and the depth.
struct Spot {
  V dx, dy, z;
};

// A value whose plane is over z, within the least and the most of the corners, for edges' sake.
HWY_INLINE V value_at(const std::array<float, 3>& over_z, float low, float high, const Spot& s) {
  return hn::Min(hn::Max(Mul(s.z, plane(over_z, s.dx, s.dy)), set(low)), set(high));
}

HWY_INLINE Spot spot(const DepthPlane& depth, const Pixels& p) {
  const V dx = Sub(p.x, set(depth.x_ref));
  const V dy = Sub(p.y, set(depth.y_ref));
  const V inverse = hn::Min(hn::Max(plane(depth.plane, dx, dy), set(depth.low)), set(depth.high));
  return {dx, dy, Div(set(1.0F), inverse)};
}

struct Normal {
  V x, y, z;
};

// What some pixels see, to be lit.
struct Surface {
  V x, y, z;  // its place in C
  Normal normal;
  Colour base, diffuse;
};

// Of a curved triangle.
HWY_INLINE Normal normal_at(const Facet& f, const Spot& s) {
  const auto& n = f.normal;
  const V second = value_at(f.second, 0.0F, 1.0F, s);
  const V third = value_at(f.third, 0.0F, 1.0F, s);
  const auto mixed = [&](const std::array<float, 3>& corners) HWY_ATTR {
    return Add(set(corners[0]), Add(Mul(set(corners[1]), second), Mul(set(corners[2]), third)));
  };
  const V x = mixed(n[0]);
  const V y = mixed(n[1]);
  const V z = mixed(n[2]);
  const V length2 = hn::Max(dot(x, y, z, x, y, z), set(1e-20F));
  const V scale = Div(set(1.0F), hn::Sqrt(length2));
  return {Mul(x, scale), Mul(y, scale), Mul(z, scale)};
}

template <class T>
using Lanes = std::array<T, hn::MaxLanes(D())>;

// The pixels of a vector, lit, and where they are in their texture.
struct Cell {
  alignas(64) Lanes<float> r, g, b;  // under its lights, before the texture; at most 1
  Lanes<float> u, v;                 // in its texture
  Lanes<float> texels_per_pixel2;    // of its largest size, squared
  Lanes<std::int32_t> level;         // 256 times the row of PreparedScene::levels
};

HWY_INLINE V load(const Lanes<float>& from) {
  return hn::Load(D(), from.data());
}
HWY_INLINE VI load(const Lanes<std::int32_t>& from) {
  return hn::Load(DI(), from.data());
}
HWY_INLINE void store(V value, Lanes<float>& to) {
  hn::Store(value, D(), to.data());
}
HWY_INLINE void store(VI value, Lanes<std::int32_t>& to) {
  hn::Store(value, DI(), to.data());
}

HWY_INLINE Colour colour(const Cell& c) {
  return {load(c.r), load(c.g), load(c.b)};
}
HWY_INLINE void store(const Colour& colour, Cell& c) {
  store(colour.r, c.r);
  store(colour.g, c.g);
  store(colour.b, c.b);
}

HWY_INLINE VI to_byte(V share) {
  return nearest(Mul(share, set(255.0F)));
}
HWY_INLINE VU packed(VI r, VI g, VI b) {
  return hn::BitCast(DU(), hn::Or(r, hn::Or(hn::ShiftLeft<8>(g), hn::ShiftLeft<16>(b))));
}
HWY_INLINE VU packed(const Colour& c, V alpha) {
  return hn::Or(packed(to_byte(c.r), to_byte(c.g), to_byte(c.b)),
                hn::BitCast(DU(), hn::ShiftLeft<24>(to_byte(alpha))));
}

}  // namespace
}  // namespace tether::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
