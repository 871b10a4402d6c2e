#include "place/transform.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "place/transform.cpp"
#include <hwy/foreach_target.h>
//
#include "vector-inl.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tether::raster::HWY_NAMESPACE {
namespace {

V row(const float* r, float t, V x, V y, V z) {
  return Add(dot(set(r[0]), set(r[1]), set(r[2]), x, y, z), set(t));
}

void mark(hn::Mask<D> where, std::int32_t as, VI& marks) {
  marks = hn::Or(marks, hn::IfThenElseZero(hn::RebindMask(DI(), where), whole(as)));
}

// A position in the picture, with what is beyond the guard moved onto it and marked.
VI place(V share, float f, float c, std::int32_t low_mark, std::int32_t high_mark, VI& marks) {
  const V at = Add(Mul(share, set(f)), set(c));
  const V low = set(static_cast<float>(-kGuard));
  const V high = set(static_cast<float>(kGuard));
  mark(hn::Lt(at, low), low_mark, marks);
  mark(hn::Gt(at, high), high_mark, marks);
  return hn::NearestInt(hn::Min(hn::Max(at, low), high));
}

// Marks what is beside the planes through the camera and the sides of what is seen, or a pixel
// farther. Things behind the camera count: no part of a triangle between such points is seen.
void mark_unseen(V share_z, V z, float f, float c, std::int32_t low, std::int32_t high,
                 std::int32_t low_mark, std::int32_t high_mark, VI& marks) {
  const V at = Mul(share_z, set(f));
  const auto beside = [&](std::int32_t side)
                          HWY_ATTR { return Mul(set(static_cast<float>(side) - c), z); };
  mark(hn::Lt(at, beside(low - kSubpixels)), kUnseen * low_mark, marks);
  mark(hn::Gt(at, beside(high + kSubpixels)), kUnseen * high_mark, marks);
}

struct Corners {
  V x, y, z;
};
Corners corners(const PlacedVertices& placed, std::size_t first) {
  const D d;
  return {hn::Load(d, placed.x.data() + first), hn::Load(d, placed.y.data() + first),
          hn::Load(d, placed.z.data() + first)};
}
Corners way(const Corners& a, const Corners& b) {
  return {Sub(b.x, a.x), Sub(b.y, a.y), Sub(b.z, a.z)};
}
V dot(const Corners& a, const Corners& b) {
  return dot(a.x, a.y, a.z, b.x, b.y, b.z);
}

// Whether the camera is behind triangles, so far that rounding does not matter.
M shows_back(const Corners& a, const Corners& b, const Corners& c) {
  const Corners p = way(a, b);
  const Corners q = way(a, c);
  const Corners normal{Sub(Mul(p.y, q.z), Mul(p.z, q.y)), Sub(Mul(p.z, q.x), Mul(p.x, q.z)),
                       Sub(Mul(p.x, q.y), Mul(p.y, q.x))};
  const V volume = dot(a, normal);
  const V size = Mul(dot(a, a), Mul(dot(p, p), dot(q, q)));
  return And(hn::Gt(volume, set(0.0F)), hn::Gt(Mul(volume, volume), Mul(size, set(1e-8F))));
}

std::uint64_t find_seen(const PlacedVertices& placed, const Cluster& cluster, bool both_sides) {
  const DI di;
  std::uint64_t seen = 0;
  for (std::size_t i = 0; i < cluster.stride; i += lanes()) {
    const auto outside = [&](std::size_t corner) HWY_ATTR {
      return hn::Load(di, placed.outside.data() + corner * cluster.stride + i);
    };
    const VI all_outside = And(outside(0), And(outside(1), outside(2)));
    M may_be_seen = hn::RebindMask(D(), hn::Eq(all_outside, whole(0)));
    if (!both_sides) {
      const M back = shows_back(corners(placed, i), corners(placed, cluster.stride + i),
                                corners(placed, 2 * cluster.stride + i));
      may_be_seen = hn::AndNot(back, may_be_seen);
    }
    std::uint64_t bits = 0;
    hn::StoreMaskBits(D(), may_be_seen, reinterpret_cast<std::uint8_t*>(&bits));
    seen |= bits << i;
  }
  return seen & (~std::uint64_t{0} >> (64 - cluster.triangles));
}

}  // namespace

// Named apart, because every processor's version of it is one function of this file.
std::uint64_t place_vertices_on(const PreparedScene& scene, const Cluster& cluster,
                                const Transformation& t, bool both_sides, PlacedVertices& out) {
  const D d;
  const DI di;
  const V near = set(t.near_m);
  const float* const r = t.rotation.data();
  for (std::size_t i = 0; i < std::size_t{3} * cluster.stride; i += hn::Lanes(d)) {
    const std::size_t at = cluster.first_corner + i;
    const V px = hn::LoadU(d, scene.x.data() + at);
    const V py = hn::LoadU(d, scene.y.data() + at);
    const V pz = hn::LoadU(d, scene.z.data() + at);
    const V x = row(r, t.translation[0], px, py, pz);
    const V y = row(r + 3, t.translation[1], px, py, pz);
    const V z = row(r + 6, t.translation[2], px, py, pz);
    const auto is_near = hn::Lt(z, near);
    VI marks = hn::IfThenElseZero(hn::RebindMask(di, is_near), whole(kNear));
    const V inverse = Div(set(1.0F), hn::IfThenElse(is_near, near, z));
    const VI u = place(Mul(x, inverse), t.fx, t.cx, kLeft, kRight, marks);
    const VI v = place(Mul(y, inverse), t.fy, t.cy, kAbove, kBelow, marks);
    mark_unseen(x, z, t.fx, t.cx, t.seen.x_low, t.seen.x_high, kLeft, kRight, marks);
    mark_unseen(y, z, t.fy, t.cy, t.seen.y_low, t.seen.y_high, kAbove, kBelow, marks);
    hn::Store(x, d, out.x.data() + i);
    hn::Store(y, d, out.y.data() + i);
    hn::Store(z, d, out.z.data() + i);
    hn::Store(u, di, out.u.data() + i);
    hn::Store(v, di, out.v.data() + i);
    hn::Store(marks, di, out.outside.data() + i);
  }
  return find_seen(out, cluster, both_sides);
}

}  // namespace tether::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tether::raster {

HWY_EXPORT(place_vertices_on);

std::uint64_t place_vertices(const PreparedScene& scene, const Cluster& cluster,
                             const Transformation& t, bool both_sides, PlacedVertices& out) {
  static_assert(Cluster::kMaxTriangles == 64);
  return HWY_DYNAMIC_DISPATCH(place_vertices_on)(scene, cluster, t, both_sides, out);
}

}  // namespace tether::raster
#endif
