#if defined(TETHER_RASTER_SURFACE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TETHER_RASTER_SURFACE_INL_H_
#undef TETHER_RASTER_SURFACE_INL_H_
#else
#define TETHER_RASTER_SURFACE_INL_H_
#endif

#include "layer.h"
#include "rasterize.h"
#include "vector-inl.h"

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

// Calls `use` with each triangle that some pixels see, and with the pixels.
template <class Use>
HWY_INLINE void for_each_facet(VU ids, M wanted, const Use& use) {
  const D d;
  const DI di;
  const VI id = hn::BitCast(di, ids);
  M rest = And(wanted, float_mask(hn::Gt(id, whole(0))));
  alignas(64) std::array<std::int32_t, kMaxLanes> all;
  hn::Store(id, di, all.data());
  while (!hn::AllFalse(d, rest)) {
    const std::int32_t first = all[static_cast<std::size_t>(hn::FindFirstTrue(d, rest))];
    const M same = And(rest, float_mask(hn::Eq(id, whole(first))));
    rest = hn::AndNot(same, rest);
    use(static_cast<std::size_t>(first - 1), same);
  }
}

// Where on a triangle some pixels look.
struct Spot {
  V z;              // the depth
  V second, third;  // the weights of the corners: within 0 and 1, for edges' sake
};

HWY_INLINE V plane(const std::array<float, 3>& p, V dx, V dy) {
  return Add(Add(set(p[0]), Mul(set(p[2]), dy)), Mul(set(p[1]), dx));
}

HWY_INLINE V weight(const std::array<float, 3>& over_z, V z, V dx, V dy) {
  return hn::Min(hn::Max(Mul(z, plane(over_z, dx, dy)), set(0.0F)), set(1.0F));
}

HWY_INLINE Spot spot(const Facet& f, V x, V y) {
  const V dx = Sub(x, set(f.x_ref));
  const V dy = Sub(y, set(f.y_ref));
  const V inverse = hn::Min(hn::Max(plane(f.inverse_depth, dx, dy), set(f.inverse_depth_low)),
                            set(f.inverse_depth_high));
  const V z = Div(set(1.0F), inverse);
  return {z, weight(f.second, z, dx, dy), weight(f.third, z, dx, dy)};
}

HWY_INLINE V between_corners(const std::array<float, 3>& corners, const Spot& s) {
  return Add(Add(set(corners[0]), Mul(set(corners[1]), s.second)), Mul(set(corners[2]), s.third));
}

// A surface before the lights: where it is and where it faces, in C.
struct Surface {
  V x, y, z;
  V nx, ny, nz;
};

HWY_INLINE Surface surface(const Facet& f, const Spot& s, const Pixels& p) {
  Surface out{Mul(p.ray_x, s.z),   Mul(p.ray_y, s.z),   s.z,
              set(f.normal[0][0]), set(f.normal[1][0]), set(f.normal[2][0])};
  if (f.is_flat != 0) return out;
  const V nx = between_corners(f.normal[0], s);
  const V ny = between_corners(f.normal[1], s);
  const V nz = between_corners(f.normal[2], s);
  const V length2 = hn::Max(dot(nx, ny, nz, nx, ny, nz), set(1e-20F));
  const V scale = Div(set(1.0F), hn::Sqrt(length2));
  out.nx = Mul(nx, scale);
  out.ny = Mul(ny, scale);
  out.nz = Mul(nz, scale);
  return out;
}

}  // namespace
}  // namespace tether::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
