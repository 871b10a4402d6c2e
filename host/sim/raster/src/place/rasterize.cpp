#include "place/rasterize.h"

#include <algorithm>
#include <bit>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "place/rasterize.cpp"
#include <hwy/foreach_target.h>
//
#include "vector-inl.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tether::raster::HWY_NAMESPACE {
namespace {

// Keeps a triangle where it is nearer than the present one.
struct Nearest {
  TileIds& ids;

  void take(std::size_t at, M inside, V inverse_depth, VU id) const {
    const D d;
    const DU du;
    const V before = hn::Load(d, ids.inverse_depth.data() + at);
    const M taken = hn::And(inside, hn::Gt(inverse_depth, before));
    hn::Store(hn::IfThenElse(taken, inverse_depth, before), d, ids.inverse_depth.data() + at);
    const VU id_before = hn::Load(du, ids.id.data() + at);
    hn::Store(hn::IfThenElse(hn::RebindMask(du, taken), id, id_before), du, ids.id.data() + at);
  }
};

// Keeps the nearest triangle that is before `behind` and behind `last`. Ids order equally far ones.
struct Next {
  const TileIds& behind;
  const TileIds& last;
  TileIds& next;

  struct Seen {
    V inverse_depth;
    VU id;
  };
  static Seen load(const TileIds& ids, std::size_t at) {
    return {hn::Load(D(), ids.inverse_depth.data() + at), hn::Load(DU(), ids.id.data() + at)};
  }
  static M is_farther(const Seen& a, const Seen& b) {
    return hn::Or(
        hn::Lt(a.inverse_depth, b.inverse_depth),
        hn::And(hn::Eq(a.inverse_depth, b.inverse_depth), hn::RebindMask(D(), hn::Lt(a.id, b.id))));
  }
  void take(std::size_t at, M inside, V inverse_depth, VU id) const {
    const D d;
    const DU du;
    const Seen here{inverse_depth, id};
    const Seen best = load(next, at);
    const M is_between =
        hn::And(is_farther(load(behind, at), here), is_farther(here, load(last, at)));
    const M taken = hn::And(inside, hn::And(is_between, is_farther(best, here)));
    hn::Store(hn::IfThenElse(taken, inverse_depth, best.inverse_depth), d,
              next.inverse_depth.data() + at);
    hn::Store(hn::IfThenElse(hn::RebindMask(du, taken), id, best.id), du, next.id.data() + at);
  }
};

// Some columns and rows of a tile, counted from its corner; whole vectors of columns.
struct Part {
  int first_column, columns, first_row, rows;

  Part(const Tile& tile, const PixelRect& pixels) {
    constexpr D d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    first_column = std::max(0, pixels.x_low - tile.x) / lanes * lanes;
    columns = std::min(tile.width - 1, pixels.x_high - tile.x) + 1 - first_column;
    first_row = std::max(0, pixels.y_low - tile.y);
    rows = std::min(tile.height - 1, pixels.y_high - tile.y) + 1 - first_row;
  }
};

std::size_t place_of(int column, int row) {
  return static_cast<std::size_t>(row) * kTile_px + static_cast<std::size_t>(column);
}

// The reciprocal of the depth, never beyond that of the corners: on a
// triangle that is seen nearly edge-on, the plane overshoots between pixels.
class Depth {
 public:
  explicit Depth(const DepthPlane& f)
      : plane_(f),
        x_ref_(hn::Set(D(), f.x_ref)),
        slope_(hn::Set(D(), f.plane[1])),
        low_(hn::Set(D(), f.low)),
        high_(hn::Set(D(), f.high)) {}

  V row(float y) const {
    return hn::Set(D(), plane_.plane[0] + plane_.plane[2] * (y - plane_.y_ref));
  }
  V row(V y) const {
    const D d;
    return hn::Add(hn::Set(d, plane_.plane[0]),
                   hn::Mul(hn::Set(d, plane_.plane[2]), hn::Sub(y, hn::Set(d, plane_.y_ref))));
  }

  V at(V row, V x) const {
    const V plane = hn::Add(row, hn::Mul(slope_, hn::Sub(x, x_ref_)));
    return hn::Min(hn::Max(plane, low_), high_);
  }

 private:
  const DepthPlane& plane_;
  V x_ref_, slope_, low_, high_;
};

// The three edges of a triangle over samples on a grid. Of E = a·x + b·y + c, whose steps from
// pixel to pixel are multiples of kSubpixels, E ≥ 0 just where E div kSubpixels is, which fits
// into 32 bits: an edge that is beyond ±kFar does not get back to 0 within a tile.
class GridEdges {
 public:
  GridEdges(const Coverage& t, int x, int y) : t_(t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int64_t e =
          t.c[i] + kSubpixels * (std::int64_t{t.a[i]} * x + std::int64_t{t.b[i]} * y);
      at_[i] = static_cast<std::int32_t>(std::clamp(e >> kShift, -kFar, kFar));
    }
  }

  // Whether no pixel of some columns and rows is inside, because one edge is beyond them.
  bool misses(int columns, int rows) const {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t most =
          at_[i] + std::max(0, t_.a[i] * (columns - 1)) + std::max(0, t_.b[i] * (rows - 1));
      if (most < 0) return true;
    }
    return false;
  }

  // Of one edge: the first row's first vector, and the steps to the next ones.
  struct Walk {
    VI first, column_step, row_step;
  };
  Walk walk(std::size_t i) const {
    const DI di;
    const VI lane = hn::Iota(di, 0);
    return {hn::Add(hn::Set(di, at_[i]), hn::Mul(lane, hn::Set(di, t_.a[i]))),
            hn::Set(di, t_.a[i] * static_cast<int>(hn::Lanes(di))), hn::Set(di, t_.b[i])};
  }

 private:
  static constexpr std::int64_t kFar = std::int64_t{1} << 30;
  static constexpr int kShift = 8;
  static_assert(kSubpixels == 1 << kShift);

  const Coverage& t_;
  std::array<std::int32_t, 3> at_{};
};

// Vectors without a pixel of the triangle are not left out: guessing which ones that are costs
// more.
template <class Target>
void rasterize_on_grid(const Coverage& t, std::uint32_t id, const Tile& tile,
                       const Target& target) {
  const Part part(tile, t.pixels);
  const int left = tile.x + part.first_column;
  const int top = tile.y + part.first_row;
  const GridEdges edges(t, left, top);
  if (edges.misses(part.columns, part.rows)) return;
  const Depth depth(t.depth);
  const VU ids = hn::Set(DU(), id);
  const std::size_t vectors = (static_cast<std::size_t>(part.columns) + lanes() - 1) / lanes();
  const V first_x = Add(lane_numbers(), set(static_cast<float>(left)));
  const V x_step = set(static_cast<float>(lanes()));
  const GridEdges::Walk e0 = edges.walk(0);
  const GridEdges::Walk e1 = edges.walk(1);
  const GridEdges::Walk e2 = edges.walk(2);
  VI row0 = e0.first;
  VI row1 = e1.first;
  VI row2 = e2.first;
  for (int row = 0; row < part.rows; ++row) {
    const V depth_row = depth.row(static_cast<float>(top + row));
    std::size_t at = place_of(part.first_column, part.first_row + row);
    V x = first_x;
    VI at0 = row0;
    VI at1 = row1;
    VI at2 = row2;
    for (std::size_t i = 0; i < vectors; ++i, at += lanes()) {
      const auto inside = hn::Gt(hn::Or(hn::Or(at0, at1), at2), whole(-1));
      target.take(at, float_mask(inside), depth.at(depth_row, x), ids);
      x = Add(x, x_step);
      at0 = Add(at0, e0.column_step);
      at1 = Add(at1, e1.column_step);
      at2 = Add(at2, e2.column_step);
    }
    row0 = Add(row0, e0.row_step);
    row1 = Add(row1, e1.row_step);
    row2 = Add(row2, e2.row_step);
  }
}

// An edge at each sample of a row: whole numbers that doubles hold exactly; as floats they keep
// their signs. Or the least of that and `least`. @pre `count` is a multiple of the lanes.
template <bool kIsFirst>
HWY_INLINE void take_edge(const Coverage& t, std::size_t i, const std::int32_t* x,
                          const std::int32_t* y, int count, float* least) {
  using DF = hn::Half<D>;
  using DD = hn::Rebind<double, DF>;
  const DD d;
  const hn::Rebind<std::int32_t, DD> di;
  const hn::Rebind<float, DD> df;
  const auto a = hn::Set(d, static_cast<double>(t.a[i]));
  const auto b = hn::Set(d, static_cast<double>(t.b[i]));
  const auto c = hn::Set(d, static_cast<double>(t.c[i]));
  for (int k = 0; k < count; k += static_cast<int>(hn::Lanes(d))) {
    const auto px = hn::PromoteTo(d, hn::LoadU(di, x + k));
    const auto py = hn::PromoteTo(d, hn::LoadU(di, y + k));
    const auto edge = hn::DemoteTo(df, hn::Add(hn::Add(hn::Mul(a, px), hn::Mul(b, py)), c));
    hn::StoreU(kIsFirst ? edge : hn::Min(edge, hn::LoadU(df, least + k)), df, least + k);
  }
}

// Samples in pixels, from kSubpixels: exact.
V in_pixels(const std::int32_t* samples) {
  const D d;
  return hn::Mul(hn::ConvertTo(d, hn::LoadU(DI(), samples)), hn::Set(d, 1.0F / kSubpixels));
}

// `bounds` are those of all of the tile's samples.
template <class Target>
void rasterize_samples(const Coverage& t, std::uint32_t id, const Tile& tile, const Lens& lens,
                       const FixedRect& bounds, const Target& target) {
  const D d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const Reach of_tile = reach(t, bounds, 7U);
  if (of_tile.is_none) return;
  const Depth depth(t.depth);
  const Part part(tile, t.pixels);
  const VU ids = hn::Set(DU(), id);
  alignas(64) std::array<float, kTile_px> least{};
  const int whole_vectors = (part.columns + lanes - 1) / lanes * lanes;
  for (int row = part.first_row; row < part.first_row + part.rows; ++row) {
    const Reach of_row =
        reach(t, lens.samples_of_block(tile.x / kTile_px, tile.y + row), of_tile.edges);
    if (of_row.is_none) continue;
    const std::size_t sample = static_cast<std::size_t>(tile.y + row) * lens.stride() +
                               static_cast<std::size_t>(tile.x + part.first_column);
    const std::int32_t* const x = lens.x().data() + sample;
    const std::int32_t* const y = lens.y().data() + sample;
    for (unsigned rest = of_row.edges; rest != 0; rest &= rest - 1) {
      const auto edge = static_cast<std::size_t>(std::countr_zero(rest));
      if (rest == of_row.edges) {
        take_edge<true>(t, edge, x, y, whole_vectors, least.data());
      } else {
        take_edge<false>(t, edge, x, y, whole_vectors, least.data());
      }
    }
    for (int c = 0; c < part.columns; c += lanes) {
      const V edges = of_row.edges == 0 ? hn::Zero(d) : hn::Load(d, least.data() + c);
      const M inside = hn::Ge(edges, hn::Zero(d));
      if (hn::AllFalse(d, inside)) continue;
      const V depth_row = depth.row(in_pixels(y + c));
      target.take(place_of(part.first_column + c, row), inside,
                  depth.at(depth_row, in_pixels(x + c)), ids);
    }
  }
}

template <class Target>
void rasterize_all(const Layer& layer, const Lens& lens, const Tile& tile,
                   std::span<const std::uint32_t> triangles, Names names, const Target& target) {
  const FixedRect bounds =
      lens.samples_of({tile.x, tile.y, tile.x + tile.width - 1, tile.y + tile.height - 1});
  for (const std::uint32_t i : triangles) {
    const std::uint32_t id = names == Names::kKeys ? layer.keys[i] : i + 1;
    if (lens.is_grid()) {
      rasterize_on_grid(layer.coverage[i], id, tile, target);
    } else {
      rasterize_samples(layer.coverage[i], id, tile, lens, bounds, target);
    }
  }
}

}  // namespace

void clear_on(float farthest, TileIds& ids) {
  const V depth = hn::Set(D(), farthest);
  for (std::size_t i = 0; i < kTilePixels; i += hn::Lanes(D())) {
    hn::Store(hn::Zero(DU()), DU(), ids.id.data() + i);
    hn::Store(depth, D(), ids.inverse_depth.data() + i);
  }
}

void rasterize_nearest_on(const Layer& layer, const Lens& lens, const Tile& tile,
                          std::span<const std::uint32_t> triangles, Names names, TileIds& ids) {
  rasterize_all(layer, lens, tile, triangles, names, Nearest{ids});
}

void rasterize_next_on(const Layer& layer, const Lens& lens, const Tile& tile,
                       std::span<const std::uint32_t> triangles, const TileIds& behind,
                       const TileIds& last, TileIds& next) {
  rasterize_all(layer, lens, tile, triangles, Names::kPlaces, Next{behind, last, next});
}

}  // namespace tether::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tether::raster {

HWY_EXPORT(clear_on);
HWY_EXPORT(rasterize_nearest_on);
HWY_EXPORT(rasterize_next_on);

void clear(double farthest_m, TileIds& ids) {
  HWY_DYNAMIC_DISPATCH(clear_on)(static_cast<float>(1.0 / farthest_m), ids);
}

void rasterize_nearest(const Layer& layer, const Lens& lens, const Tile& tile,
                       std::span<const std::uint32_t> triangles, Names names, TileIds& ids) {
  HWY_DYNAMIC_DISPATCH(rasterize_nearest_on)(layer, lens, tile, triangles, names, ids);
}

bool rasterize_next(const Layer& layer, const Lens& lens, const Tile& tile,
                    std::span<const std::uint32_t> triangles, const TileIds& behind,
                    const TileIds& last, TileIds& next) {
  clear(std::numeric_limits<double>::infinity(), next);
  HWY_DYNAMIC_DISPATCH(rasterize_next_on)(layer, lens, tile, triangles, behind, last, next);
  return std::any_of(next.id.begin(), next.id.end(), [](std::uint32_t id) { return id != 0; });
}

}  // namespace tether::raster
#endif
