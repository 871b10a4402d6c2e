#if defined(TETHER_RASTER_SURFACE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TETHER_RASTER_SURFACE_INL_H_
#undef TETHER_RASTER_SURFACE_INL_H_
#else
#define TETHER_RASTER_SURFACE_INL_H_
#endif

#include "layer.h"
#include "rasterize.h"
#include "shade.h"
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

// A layer's part of a tile, from one of its rows on.
struct Part {
  const Shading& shading;
  const Layer& layer;
  const Tile& tile;
  const TileIds& ids;
  int first_row, rows;

  std::size_t first_pixel() const { return static_cast<std::size_t>(first_row) * kTile_px; }
};

// Where some pixels are in the undistorted picture, and the slopes of their rays.
struct Pixels {
  V x, y;
  V ray_x, ray_y;
};

// The pixels of a part. A copy of what it takes: nothing that is stored can change it.
class Sight {
 public:
  explicit Sight(const Part& part)
      : lens_(part.shading.lens),
        is_grid_(lens_.is_grid()),
        x_(part.tile.x),
        y_(part.tile.y + part.first_row),
        offset_x_(static_cast<float>(part.layer.offset_x_px)),
        offset_y_(static_cast<float>(part.layer.offset_y_px)),
        cx_(static_cast<float>(part.layer.projection.cx)),
        cy_(static_cast<float>(part.layer.projection.cy)),
        per_fx_(static_cast<float>(1.0 / part.layer.projection.fx)),
        per_fy_(static_cast<float>(1.0 / part.layer.projection.fy)) {}

  // From pixel `at` of the part on, all in one row.
  HWY_INLINE Pixels pixels(std::size_t at) const {
    const int column = x_ + static_cast<int>(at % kTile_px);
    const int row = y_ + static_cast<int>(at / kTile_px);
    Pixels p;
    if (is_grid_) {
      p.x = Add(Add(lane_numbers(), set(static_cast<float>(column))), set(offset_x_));
      const float y = static_cast<float>(row) + offset_y_;
      p.y = set(y);
      p.ray_y = set((y - cy_) * per_fy_);
    } else {
      const std::size_t sample =
          static_cast<std::size_t>(row) * lens_.stride() + static_cast<std::size_t>(column);
      const V scale = set(1.0F / kSubpixels);
      p.x = Mul(to_float(hn::LoadU(DI(), lens_.x().data() + sample)), scale);
      p.y = Mul(to_float(hn::LoadU(DI(), lens_.y().data() + sample)), scale);
      p.x = Add(p.x, set(offset_x_));
      p.y = Add(p.y, set(offset_y_));
      p.ray_y = Mul(Sub(p.y, set(cy_)), set(per_fy_));
    }
    p.ray_x = Mul(Sub(p.x, set(cx_)), set(per_fx_));
    return p;
  }

 private:
  const Lens& lens_;
  bool is_grid_;
  int x_, y_;
  float offset_x_, offset_y_, cx_, cy_, per_fx_, per_fy_;
};

// Calls `use` with each number of some pixels that is not 0, less 1; with its pixels, and with
// whether it is the first.
template <class Use>
HWY_INLINE void for_each_number(VU ids, const Use& use) {
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

HWY_INLINE Spot spot(const Facet& f, const Pixels& p, V z) {
  return {Sub(p.x, set(f.x_ref)), Sub(p.y, set(f.y_ref)), z};
}

// A value whose plane is over z, within the least and the most of the corners, for edges' sake.
HWY_INLINE V value_at(const std::array<float, 3>& over_z, float low, float high, const Spot& s) {
  return hn::Min(hn::Max(Mul(s.z, plane(over_z, s.dx, s.dy)), set(low)), set(high));
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

HWY_INLINE Normal normal_at(const Facet& f, const Spot& s) {
  const auto& n = f.normal;
  if (f.is_flat != 0) return {set(n[0][0]), set(n[1][0]), set(n[2][0])};
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

// The pixels of a vector.
struct Cell {
  alignas(64) Lanes<float> r, g, b;  // under its lights, before the texture; at most 1
  Lanes<float> u, v;                 // in its texture
  Lanes<float> texels_per_pixel2;    // of its largest size, squared; at least 1
  Lanes<std::int32_t> level;         // 256 times the row of PreparedScene::levels
  Lanes<std::int32_t> material;      // rows of PreparedScene::materials, unless the run is flat
};

// Some rows of a tile, step by step: each step goes over all pixels, a vector at a time. Pixels
// that see different triangles share a vector from the second step on. So few rows stay in the
// cache.
struct Block {
  static constexpr int kRows = 4;
  static constexpr std::size_t kPixels = std::size_t{kRows} * kTile_px;

  // Vectors that follow each other, with triangles in them.
  struct Run {
    const Facet* flat;         // the triangle of all their pixels, if it is one and flat; else null
    std::uint16_t first, end;  // of `places`
    bool is_textured;
  };

  alignas(64) std::array<std::uint32_t, kPixels> ids;  // the input: 0 where nothing is to be shaded
  std::array<Cell, kPixels / hn::MaxLanes(D())> cells;
  std::array<Run, kPixels> all_runs;
  std::array<std::uint16_t, kPixels> all_places;
  std::size_t run_count;

  Cell& cell(std::size_t at) { return cells[at / hn::MaxLanes(D())]; }
  const Cell& cell(std::size_t at) const { return cells[at / hn::MaxLanes(D())]; }
  std::span<const Run> runs() const { return {all_runs.data(), run_count}; }
  std::span<const std::uint16_t> places(const Run& run) const {
    return std::span(all_places).subspan(run.first, run.end - run.first);
  }
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

// A number of each pixel's material, and that of the first material.
HWY_INLINE V of_material(const Block::Run& run, const Cell& c, const float& of_first) {
  constexpr std::int32_t kFloats = sizeof(MaterialRow) / sizeof(float);
  if (run.flat != nullptr) return set((&of_first)[run.flat->material * kFloats]);
  return hn::GatherIndex(D(), &of_first, Mul(load(c.material), whole(kFloats)));
}

}  // namespace
}  // namespace tether::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
