#if defined(TETHER_RASTER_LIGHT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TETHER_RASTER_LIGHT_INL_H_
#undef TETHER_RASTER_LIGHT_INL_H_
#else
#define TETHER_RASTER_LIGHT_INL_H_
#endif

#include "shade.h"
#include "surface-inl.h"
#include "vector-inl.h"

// Lights, as OpenGL's fixed pipeline has them, for each pixel.
HWY_BEFORE_NAMESPACE();
namespace tether::raster::HWY_NAMESPACE {
namespace {

// Which of four neighbours in a light's picture are lit, at 1/depth.
HWY_INLINE V lit(const ShadowMap& map, VI at, V inverse) {
  return hn::IfThenElseZero(hn::Ge(inverse, hn::GatherIndex(D(), map.inverse_depth(), at)),
                            set(1.0F));
}

HWY_INLINE V row(const std::array<float, 12>& m, std::size_t i, const Surface& s) {
  return Add(dot(set(m[i]), set(m[i + 1]), set(m[i + 2]), s.x, s.y, s.z), set(m[i + 3]));
}

// The share of a light that reaches a surface, 0..1: bilinear between the four nearest pixels of
// the light's picture. A surface outside of that picture is lit.
HWY_INLINE V lit_share(const ShadowMap& map, const LightRow& light, const Surface& s) {
  const V z = row(light.to_shadow, 8, s);
  const V least = set(1e-6F);
  const V inverse = Div(set(1.0F), hn::Max(z, least));
  const V u = Mul(row(light.to_shadow, 0, s), inverse);
  const V v = Mul(row(light.to_shadow, 4, s), inverse);
  const V zero = set(0.0F);
  const V last = set(static_cast<float>(ShadowMap::kSize_px - 1));
  const M is_seen = And(And(hn::Gt(z, zero), And(hn::Ge(u, zero), hn::Lt(u, last))),
                        And(hn::Ge(v, zero), hn::Lt(v, last)));
  if (hn::AllFalse(D(), is_seen)) return set(1.0F);
  const V left = hn::Floor(hn::IfThenElseZero(is_seen, u));
  const V top = hn::Floor(hn::IfThenElseZero(is_seen, v));
  const VI at = Add(Mul(nearest(top), whole(ShadowMap::kSize_px)), nearest(left));
  const VI below = Add(at, whole(ShadowMap::kSize_px));
  const V nearer = Div(set(1.0F), hn::Max(Sub(z, set(map.bias_m())), least));
  const V across = Sub(u, left);
  const V upper = mix(lit(map, at, nearer), lit(map, Add(at, whole(1)), nearer), across);
  const V lower = mix(lit(map, below, nearer), lit(map, Add(below, whole(1)), nearer), across);
  return hn::IfThenElse(is_seen, mix(upper, lower, Sub(v, top)), set(1.0F));
}

// Blinn's highlight: the cosine between the normal and the half of light and view, to a power.
HWY_INLINE V highlight(const Surface& s, V lx, V ly, V lz, float shininess) {
  const V view = Div(set(-1.0F), hn::Sqrt(dot(s.x, s.y, s.z, s.x, s.y, s.z)));
  const V hx = Add(lx, Mul(s.x, view));
  const V hy = Add(ly, Mul(s.y, view));
  const V hz = Add(lz, Mul(s.z, view));
  const V length2 = hn::Max(dot(hx, hy, hz, hx, hy, hz), set(1e-20F));
  const V cosine = Div(dot(s.nx, s.ny, s.nz, hx, hy, hz), hn::Sqrt(length2));
  return hn::IfThenElseZero(hn::Gt(cosine, set(0.0F)),
                            power(hn::Min(cosine, set(1.0F)), shininess));
}

// The share of a spot's light at the cosine of the angle off its direction.
HWY_INLINE V spot_share(const LightRow& light, V cosine) {
  const M is_inside = hn::Ge(cosine, set(light.cos_cutoff));
  if (light.exponent == 0.0F) return hn::IfThenElseZero(is_inside, set(1.0F));
  return hn::IfThenElseZero(And(is_inside, hn::Gt(cosine, set(0.0F))),
                            power(hn::Min(cosine, set(1.0F)), light.exponent));
}

// The light that reaches a surface, before the surface's colours.
struct LightSum {
  Colour diffuse, specular;
};

// Light from a direction (x, y, z) that need not be unit.
struct Ray {
  V x, y, z;
  V cosine;  // times the length
  V share;   // of the light that is left
  V over_length;
};

HWY_INLINE Ray aim(const LightRow& light, const Surface& s) {
  Ray ray;
  if (light.is_directional) {
    ray.x = set(-light.direction[0]);
    ray.y = set(-light.direction[1]);
    ray.z = set(-light.direction[2]);
  } else {
    ray.x = Sub(set(light.position[0]), s.x);
    ray.y = Sub(set(light.position[1]), s.y);
    ray.z = Sub(set(light.position[2]), s.z);
  }
  ray.cosine = dot(s.nx, s.ny, s.nz, ray.x, ray.y, ray.z);
  ray.share = ray.over_length = set(1.0F);
  return ray;
}

HWY_INLINE void attenuate(const LightRow& light, Ray& ray) {
  if (light.is_directional) return;
  const V length = hn::Sqrt(hn::Max(dot(ray.x, ray.y, ray.z, ray.x, ray.y, ray.z), set(1e-20F)));
  const auto& a = light.attenuation;
  const V sum = Add(set(a[0]), Mul(length, Add(set(a[1]), Mul(set(a[2]), length))));
  const V over_both = Div(set(1.0F), Mul(length, sum));
  ray.share = Mul(over_both, length);
  ray.over_length = Mul(over_both, sum);
  if (light.cos_cutoff < -1.0F) return;
  const auto& d = light.direction;
  const V against = dot(ray.x, ray.y, ray.z, set(-d[0]), set(-d[1]), set(-d[2]));
  ray.share = Mul(ray.share, spot_share(light, Mul(against, ray.over_length)));
}

// Adds one light for the pixels of `wanted` that face it.
HWY_INLINE void add_light(const Shading& shading, const LightRow& light, const Surface& s,
                          const MaterialRow& material, M wanted, LightSum& sum) {
  Ray ray = aim(light, s);
  const M faces = And(wanted, hn::Gt(ray.cosine, set(0.0F)));
  if (hn::AllFalse(D(), faces)) return;
  attenuate(light, ray);
  if (light.shadow >= 0) {
    const auto map = static_cast<std::size_t>(light.shadow);
    ray.share = Mul(ray.share, lit_share(shading.shadows[map], light, s));
  }
  ray.share = hn::IfThenElseZero(faces, ray.share);
  add_to(sum.diffuse, colour(light.diffuse), Mul(ray.share, Mul(ray.cosine, ray.over_length)));
  if (!light.has_specular || material.is_shiny == 0) return;
  const V shine = highlight(s, Mul(ray.x, ray.over_length), Mul(ray.y, ray.over_length),
                            Mul(ray.z, ray.over_length), material.shininess);
  add_to(sum.specular, colour(light.specular), Mul(ray.share, shine));
}

// A surface's colour under all lights, at most 1, before its texture.
HWY_INLINE Colour lit_colour(const Shading& shading, const Layer& layer,
                             const MaterialRow& material, const Surface& s, M wanted) {
  const Colour black{set(0.0F), set(0.0F), set(0.0F)};
  LightSum sum{black, black};
  for (const LightRow& light : layer.lights) {
    add_light(shading, light, s, material, wanted, sum);
  }
  const Colour diffuse = scaled(sum.diffuse, colour(material.diffuse));
  const Colour specular = scaled(sum.specular, colour(material.specular));
  const Colour base = colour(material.base);
  const V one = set(1.0F);
  return {hn::Min(Add(Add(base.r, diffuse.r), specular.r), one),
          hn::Min(Add(Add(base.g, diffuse.g), specular.g), one),
          hn::Min(Add(Add(base.b, diffuse.b), specular.b), one)};
}

}  // namespace
}  // namespace tether::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
