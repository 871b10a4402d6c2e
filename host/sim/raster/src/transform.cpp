#include "transform.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "transform.cpp"
#include <hwy/foreach_target.h>
//
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tether::raster::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<float, kMaxLanes>;
using V = hn::Vec<D>;

V row(const float* r, float t, V x, V y, V z) {
  const D d;
  return hn::Add(hn::Add(hn::Add(hn::Mul(hn::Set(d, r[0]), x), hn::Mul(hn::Set(d, r[1]), y)),
                         hn::Mul(hn::Set(d, r[2]), z)),
                 hn::Set(d, t));
}

// A position in the picture, with what is beyond the guard moved onto it and marked.
template <class VI>
VI place(V share, float f, float c, std::int32_t low_mark, std::int32_t high_mark, VI& marks) {
  const D d;
  const hn::RebindToSigned<D> di;
  const V at = hn::Add(hn::Mul(share, hn::Set(d, f)), hn::Set(d, c));
  const V low = hn::Set(d, static_cast<float>(-kGuard));
  const V high = hn::Set(d, static_cast<float>(kGuard));
  const auto is_low = hn::RebindMask(di, hn::Lt(at, low));
  const auto is_high = hn::RebindMask(di, hn::Gt(at, high));
  marks = hn::Or(marks, hn::IfThenElseZero(is_low, hn::Set(di, low_mark)));
  marks = hn::Or(marks, hn::IfThenElseZero(is_high, hn::Set(di, high_mark)));
  return hn::NearestInt(hn::Min(hn::Max(at, low), high));
}

void place_all(const PreparedScene& scene, const Cluster& cluster, const Transformation& t,
               PlacedVertices& out) {
  const D d;
  const hn::RebindToSigned<D> di;
  const V near = hn::Set(d, t.near_m);
  const V one = hn::Set(d, 1.0F);
  const float* const r = t.rotation.data();
  for (std::size_t i = 0; i < cluster.vertices; i += hn::Lanes(d)) {
    const std::size_t at = cluster.first_vertex + i;
    const V px = hn::LoadU(d, scene.x.data() + at);
    const V py = hn::LoadU(d, scene.y.data() + at);
    const V pz = hn::LoadU(d, scene.z.data() + at);
    const V x = row(r, t.translation[0], px, py, pz);
    const V y = row(r + 3, t.translation[1], px, py, pz);
    const V z = row(r + 6, t.translation[2], px, py, pz);
    const auto is_near = hn::Lt(z, near);
    auto marks = hn::IfThenElseZero(hn::RebindMask(di, is_near), hn::Set(di, std::int32_t{kNear}));
    const V inverse = hn::Div(one, hn::IfThenElse(is_near, near, z));
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

}  // namespace

// Named apart, because every processor's version of it is one function of this file.
void place_vertices_on(const PreparedScene& scene, const Cluster& cluster, const Transformation& t,
                       PlacedVertices& out) {
  place_all(scene, cluster, t, out);
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
