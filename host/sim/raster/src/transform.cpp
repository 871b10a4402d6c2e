#include "transform.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "transform.cpp"
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

// A position in the picture, with what is beyond the guard moved onto it and marked.
VI place(V share, float f, float c, std::int32_t low_mark, std::int32_t high_mark, VI& marks) {
  const DI di;
  const V at = Add(Mul(share, set(f)), set(c));
  const V low = set(static_cast<float>(-kGuard));
  const V high = set(static_cast<float>(kGuard));
  const auto is_low = hn::RebindMask(di, hn::Lt(at, low));
  const auto is_high = hn::RebindMask(di, hn::Gt(at, high));
  marks = hn::Or(marks, hn::IfThenElseZero(is_low, whole(low_mark)));
  marks = hn::Or(marks, hn::IfThenElseZero(is_high, whole(high_mark)));
  return hn::NearestInt(hn::Min(hn::Max(at, low), high));
}

}  // namespace

// Named apart, because every processor's version of it is one function of this file.
void place_vertices_on(const PreparedScene& scene, const Cluster& cluster, const Transformation& t,
                       PlacedVertices& out) {
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
    auto marks = hn::IfThenElseZero(hn::RebindMask(di, is_near), whole(kNear));
    const V inverse = Div(set(1.0F), hn::IfThenElse(is_near, near, z));
    const auto u = place(hn::Mul(x, inverse), t.fx, t.cx, kLeft, kRight, marks);
    const auto v = place(hn::Mul(y, inverse), t.fy, t.cy, kAbove, kBelow, marks);
    hn::Store(x, d, out.x.data() + i);
    hn::Store(y, d, out.y.data() + i);
    hn::Store(z, d, out.z.data() + i);
    hn::Store(u, di, out.u.data() + i);
    hn::Store(v, di, out.v.data() + i);
    hn::Store(marks, di, out.outside.data() + i);
  }
}

}  // namespace tether::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tether::raster {

HWY_EXPORT(place_vertices_on);

void place_vertices(const PreparedScene& scene, const Cluster& cluster, const Transformation& t,
                    PlacedVertices& out) {
  HWY_DYNAMIC_DISPATCH(place_vertices_on)(scene, cluster, t, out);
}

}  // namespace tether::raster
#endif
