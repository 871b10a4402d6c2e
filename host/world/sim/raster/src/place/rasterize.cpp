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

  V along_x(V x) const { return hn::Mul(slope_, hn::Sub(x, x_ref_)); }

  V at(V row, V along_x) const { return hn::Min(hn::Max(hn::Add(row, along_x), low_), high_); }

 private:
  const DepthPlane& plane_;
  V x_ref_, slope_, low_, high_;
};

// The three edges of a triangle over a tile's samples on a grid. Of E = a·x + b·y + c, whose steps
// from pixel to pixel are multiples of kSubpixels, E ≥ 0 just where E div kSubpixels is, which fits
// into 32 bits: an edge that is beyond ±kFar does not get back to 0 within a tile.
class GridEdges {
 public:
  // Of the tile's pixels from (x, y) on, so many columns and rows.
  GridEdges(const Coverage& t, int x, int y, int columns, int rows) : t_(t) {
    for (std::size_t i = 0; i < 3 && !misses_; ++i) {
      const std::int64_t e =
          t.c[i] + kSubpixels * (std::int64_t{t.a[i]} * x + std::int64_t{t.b[i]} * y);
      at_[i] = static_cast<std::int32_t>(std::clamp(e >> kShift, -kFar, kFar));
      rows_per_step_[i] = -1.0F / static_cast<float>(t.b[i]);
      misses_ = at_[i] + std::max(0, t.a[i] * (columns - 1)) + std::max(0, t.b[i] * (rows - 1)) < 0;
    }
  }

  // Whether no pixel is inside, because one edge is beyond them all.
  bool misses() const { return misses_; }

  struct Rows {
    int first, last;
  };
  // The rows in which a pixel of a vector may be inside. Each edge bounds them; a row too many does
  // no harm.
  Rows rows(int column, int count) const {
    constexpr float kSlack = 0.01F;
    float low = 0.0F;
    float high = static_cast<float>(count - 1);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t a = t_.a[i];
      const std::int32_t most =
          at_[i] + a * column + std::max(0, a * (static_cast<int>(lanes()) - 1));
      const float zero = static_cast<float>(most) * rows_per_step_[i];
      if (t_.b[i] > 0) low = std::max(low, zero);
      if (t_.b[i] < 0) high = std::min(high, zero);
    }
    return {static_cast<int>(low + (1.0F - kSlack)), static_cast<int>(high + kSlack)};
  }

  // One edge at a vector's pixels.
  VI at(std::size_t i, int column, int row) const {
    const VI lane = hn::Iota(DI(), 0);
    return hn::Add(whole(at_[i] + t_.a[i] * column + t_.b[i] * row), hn::Mul(lane, whole(t_.a[i])));
  }

 private:
  static constexpr std::int64_t kFar = std::int64_t{1} << 30;
  static constexpr int kShift = 8;
  static_assert(kSubpixels == 1 << kShift);

  const Coverage& t_;
  std::array<std::int32_t, 3> at_;
  std::array<float, 3> rows_per_step_;  // −1/b; not used where b = 0
  bool misses_ = false;
};

template <class Target>
void rasterize_on_grid(const Coverage& t, std::uint32_t id, const Tile& tile,
                       const Target& target) {
  const Part part(tile, t.pixels);
  const int left = tile.x + part.first_column;
  const int top = tile.y + part.first_row;
  const GridEdges edges(t, left, top, part.columns, part.rows);
  if (edges.misses()) return;
  const Depth depth(t.depth);
  const VU ids = hn::Set(DU(), id);
  const VI step0 = whole(t.b[0]);
  const VI step1 = whole(t.b[1]);
  const VI step2 = whole(t.b[2]);
  for (int column = 0; column < part.columns; column += static_cast<int>(lanes())) {
    const GridEdges::Rows rows = edges.rows(column, part.rows);
    if (rows.first > rows.last) continue;
    const V depth_x = depth.along_x(Add(lane_numbers(), set(static_cast<float>(left + column))));
    VI at0 = edges.at(0, column, rows.first);
    VI at1 = edges.at(1, column, rows.first);
    VI at2 = edges.at(2, column, rows.first);
    for (int row = rows.first; row <= rows.last; ++row) {
      const auto inside = hn::Gt(hn::Or(hn::Or(at0, at1), at2), whole(-1));
      const V depth_y = depth.row(static_cast<float>(top + row));
      target.take(place_of(part.first_column + column, part.first_row + row), float_mask(inside),
                  depth.at(depth_y, depth_x), ids);
      at0 = Add(at0, step0);
      at1 = Add(at1, step1);
      at2 = Add(at2, step2);
    }
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
                  depth.at(depth_row, depth.along_x(in_pixels(x + c))), ids);
    }
  }
}

template <class Target>
void rasterize_all(const Layer& layer, const Lens& lens, const Tile& tile,
                   std::span<const std::uint32_t> triangles, Names names, const Target& target) {
  const FixedRect bounds = lens.samples_of(pixels_of(tile));
  for (const std::uint32_t i : triangles) {
    const std::uint32_t id = name_of(layer, i, names);
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

std::optional<std::uint32_t> find_only(const Layer& layer, const Lens& lens, const Tile& tile,
                                       std::span<const std::uint32_t> triangles,
                                       double farthest_m) {
  const FixedRect bounds = lens.samples_of(pixels_of(tile));
  std::optional<std::uint32_t> only;
  for (const std::uint32_t i : triangles) {
    const Reach of_tile = reach(layer.coverage[i], bounds, 7U);
    if (of_tile.is_none) continue;
    if (only || of_tile.edges != 0) return std::nullopt;
    only = i;
  }
  const auto least = static_cast<float>(1.0 / farthest_m);
  return only && layer.coverage[*only].depth.low > least ? only : std::nullopt;
}

void clear(double farthest_m, TileIds& ids) {
  ids.everywhere = 0;
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
