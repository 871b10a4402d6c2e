#if defined(TETHER_RASTER_LIGHT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TETHER_RASTER_LIGHT_INL_H_
#undef TETHER_RASTER_LIGHT_INL_H_
#else
#define TETHER_RASTER_LIGHT_INL_H_
#endif

#include "shade/shade.h"
#include "shade/surface-inl.h"
#include "vector-inl.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>

// Lights, as OpenGL's fixed pipeline has them, for each pixel.
HWY_BEFORE_NAMESPACE();
namespace tether::raster::HWY_NAMESPACE {
namespace {

// Which of four neighbours in a light's picture are lit, at 1/depth.
HWY_INLINE V lit(const ShadowMap& map, VI at, V inverse) {
  return hn::IfThenElseZero(hn::Ge(inverse, hn::GatherIndex(D(), map.inverse_depth(), at)),
                            set(1.0F));
}

HWY_INLINE V row(const std::array<float, 12>& m, std::size_t i, V x, V y, V z) {
  return Add(dot(set(m[i]), set(m[i + 1]), set(m[i + 2]), x, y, z), set(m[i + 3]));
}

// The share of a light that reaches a surface, 0..1: bilinear between the four nearest pixels of
// the light's picture. A surface outside of that picture is lit.
HWY_INLINE V lit_share(const ShadowMap& map, const std::array<float, 12>& to_map, const Normal& n,
                       V x, V y, V z) {
  const V offset = Mul(row(to_map, 8, x, y, z), set(map.offset_per_depth()));
  const V px = Add(x, Mul(n.x, offset));
  const V py = Add(y, Mul(n.y, offset));
  const V pz = Add(z, Mul(n.z, offset));
  const V depth = row(to_map, 8, px, py, pz);
  const V inverse = Div(set(1.0F), hn::Max(depth, set(1e-6F)));
  const V u = Mul(row(to_map, 0, px, py, pz), inverse);
  const V v = Mul(row(to_map, 4, px, py, pz), inverse);
  const V zero = set(0.0F);
  const V last = set(static_cast<float>(ShadowMap::kSize_px - 1));
  const M is_seen = And(And(hn::Gt(depth, zero), And(hn::Ge(u, zero), hn::Lt(u, last))),
                        And(hn::Ge(v, zero), hn::Lt(v, last)));
  if (hn::AllFalse(D(), is_seen)) return set(1.0F);
  const V left = hn::Floor(hn::IfThenElseZero(is_seen, u));
  const V top = hn::Floor(hn::IfThenElseZero(is_seen, v));
  const VI at = Add(Mul(nearest(top), whole(ShadowMap::kSize_px)), nearest(left));
  const VI below = Add(at, whole(ShadowMap::kSize_px));
  const V across = Sub(u, left);
  const V upper = mix(lit(map, at, inverse), lit(map, Add(at, whole(1)), inverse), across);
  const V lower = mix(lit(map, below, inverse), lit(map, Add(below, whole(1)), inverse), across);
  return hn::IfThenElse(is_seen, mix(upper, lower, Sub(v, top)), set(1.0F));
}

// x^e, of x within 0 and 1 and e in 1/256: by squares and square roots.
HWY_INLINE V power(V x, float e) {
  auto rest = static_cast<std::uint32_t>(std::lround(e * 256.0F));
  V result = set(1.0F);
  V root = x;
  for (std::uint32_t bit = 128; (rest & 0xFFU) != 0; bit >>= 1U) {
    root = hn::Sqrt(root);
    if ((rest & bit) != 0) result = Mul(result, root);
    rest &= ~bit;
  }
  V square = x;
  for (rest >>= 8U; rest != 0; rest >>= 1U) {
    if ((rest & 1U) != 0) result = Mul(result, square);
    square = Mul(square, square);
  }
  return result;
}

HWY_INLINE V power_of_cosine(V cosine, float e) {
  return power(hn::Min(hn::Max(cosine, set(0.0F)), set(1.0F)), e);
}

HWY_INLINE V load(const LightRow::Splat& from) {
  return hn::Load(D(), from.data());
}
HWY_INLINE Colour colour(const std::array<LightRow::Splat, 3>& c) {
  return {load(c[0]), load(c[1]), load(c[2])};
}
HWY_INLINE V dot(const Normal& n, V x, V y, V z) {
  return dot(n.x, n.y, n.z, x, y, z);
}

// The way from a surface to a light.
struct Ray {
  V x, y, z;
  V length;
  V cost;  // what divides the light: by how much it is weakened, times the length
};

HWY_INLINE Ray aim(const LightRow& light, const Surface& s) {
  const V x = Sub(load(light.position[0]), s.x);
  const V y = Sub(load(light.position[1]), s.y);
  const V z = Sub(load(light.position[2]), s.z);
  // Not 0: what a light gives stays finite.
  const V length2 = hn::Max(dot(x, y, z, x, y, z), set(1e-12F));
  const V length = hn::Sqrt(length2);
  const auto& a = light.attenuation;
  const V loss = Add(Add(load(a[0]), Mul(load(a[2]), length2)), Mul(load(a[1]), length));
  return {x, y, z, length, Mul(length, loss)};
}

HWY_INLINE Ray sun_ray(const LightRow& light) {
  const auto& d = light.direction;
  const V one = set(1.0F);
  return {hn::Neg(load(d[0])), hn::Neg(load(d[1])), hn::Neg(load(d[2])), one, one};
}

// The share of a spot's light in the direction of the ray.
HWY_INLINE V spot_share(const LightRow& light, const Ray& ray) {
  const auto& d = light.direction;
  const V cosine =
      Div(dot(hn::Neg(load(d[0])), hn::Neg(load(d[1])), hn::Neg(load(d[2])), ray.x, ray.y, ray.z),
          ray.length);
  return hn::IfThenElseZero(hn::Ge(cosine, set(light.cos_cutoff)),
                            power_of_cosine(cosine, light.exponent));
}

// Blinn's highlight: the cosine between the normal and the half of light and view, to a power.
HWY_INLINE V highlight(const Surface& s, float exponent, const Ray& ray) {
  const V over_length = Div(set(1.0F), ray.length);
  const V view = Div(set(-1.0F), hn::Sqrt(dot(s.x, s.y, s.z, s.x, s.y, s.z)));
  const V hx = Add(Mul(ray.x, over_length), Mul(s.x, view));
  const V hy = Add(Mul(ray.y, over_length), Mul(s.y, view));
  const V hz = Add(Mul(ray.z, over_length), Mul(s.z, view));
  const V length2 = hn::Max(dot(hx, hy, hz, hx, hy, hz), set(1e-20F));
  const V cosine = Div(dot(s.normal, hx, hy, hz), hn::Sqrt(length2));
  return power_of_cosine(cosine, exponent);
}

// How much of a light reaches some surfaces: spots and shadows.
HWY_INLINE V share_of(const Shading& shading, const LightRow& light, const Surface& s,
                      const Ray& ray) {
  V share = set(1.0F);
  if (light.cos_cutoff >= -1.0F) share = spot_share(light, ray);
  if (light.shadow < 0) return share;
  const ShadowMap* map = &shading.shadows[static_cast<std::size_t>(light.shadow)];
  for (const std::array<float, 12>& to_map : light.to_shadow) {
    share = Mul(share, lit_share(*map++, to_map, s.normal, s.x, s.y, s.z));
  }
  return share;
}

// The colours of surfaces under all lights, before their textures, at most 1. Light of one colour
// is added up before it is coloured. Without a material, nothing shines, and all lights are points
// without shadows.
template <class Material>
HWY_INLINE Colour light_up(const Shading& shading, const Layer& layer, const Surface& s,
                           const Material& material) {
  constexpr bool kIsPlain = std::is_null_pointer_v<Material>;
  const V zero = set(0.0F);
  Colour sum = s.base;
  V diffuse = zero;
  [[maybe_unused]] V specular = zero;
  for (const LightRow& light : layer.lights) {
    const Ray ray = !kIsPlain && light.is_directional ? sun_ray(light) : aim(light, s);
    V toward = hn::Max(dot(s.normal, ray.x, ray.y, ray.z), zero);
    if constexpr (!kIsPlain) {
      // A side that is turned away needs no shadows.
      if (!hn::AllTrue(D(), hn::Eq(toward, zero))) {
        const V share = share_of(shading, light, s, ray);
        if (light.has_specular && material.is_shiny != 0) {
          const V shine =
              Mul(Div(Mul(share, ray.length), ray.cost), highlight(s, material.shininess, ray));
          specular = Add(specular, hn::IfThenElseZero(hn::Gt(toward, zero), shine));
        }
        toward = Mul(toward, share);
      }
    }
    diffuse = Add(diffuse, Div(toward, ray.cost));
    if (!light.is_last_of_colour) continue;
    add_to(sum, scaled(colour(light.diffuse), s.diffuse), diffuse);
    diffuse = zero;
    if constexpr (!kIsPlain) {
      if (material.is_shiny != 0) {
        add_to(sum, scaled(colour(light.specular), colour(material.specular)), specular);
      }
      specular = zero;
    }
  }
  const V one = set(1.0F);
  return {hn::Min(sum.r, one), hn::Min(sum.g, one), hn::Min(sum.b, one)};
}

}  // namespace
}  // namespace tether::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
