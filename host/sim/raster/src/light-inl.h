#if defined(TETHER_RASTER_LIGHT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TETHER_RASTER_LIGHT_INL_H_
#undef TETHER_RASTER_LIGHT_INL_H_
#else
#define TETHER_RASTER_LIGHT_INL_H_
#endif

#include "shade.h"
#include "surface-inl.h"
#include "vector-inl.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

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
HWY_INLINE V lit_share(const ShadowMap& map, const LightRow& light, V x, V y, V z) {
  const V depth = row(light.to_shadow, 8, x, y, z);
  const V least = set(1e-6F);
  const V inverse = Div(set(1.0F), hn::Max(depth, least));
  const V u = Mul(row(light.to_shadow, 0, x, y, z), inverse);
  const V v = Mul(row(light.to_shadow, 4, x, y, z), inverse);
  const V zero = set(0.0F);
  const V last = set(static_cast<float>(ShadowMap::kSize_px - 1));
  const M is_seen = And(And(hn::Gt(depth, zero), And(hn::Ge(u, zero), hn::Lt(u, last))),
                        And(hn::Ge(v, zero), hn::Lt(v, last)));
  if (hn::AllFalse(D(), is_seen)) return set(1.0F);
  const V left = hn::Floor(hn::IfThenElseZero(is_seen, u));
  const V top = hn::Floor(hn::IfThenElseZero(is_seen, v));
  const VI at = Add(Mul(nearest(top), whole(ShadowMap::kSize_px)), nearest(left));
  const VI below = Add(at, whole(ShadowMap::kSize_px));
  const V nearer = Div(set(1.0F), hn::Max(Sub(depth, set(map.bias_m())), least));
  const V across = Sub(u, left);
  const V upper = mix(lit(map, at, nearer), lit(map, Add(at, whole(1)), nearer), across);
  const V lower = mix(lit(map, below, nearer), lit(map, Add(below, whole(1)), nearer), across);
  return hn::IfThenElse(is_seen, mix(upper, lower, Sub(v, top)), set(1.0F));
}

// x^e, of x within 0 and 1 and e in 1/256: by squares and square roots.
HWY_INLINE V power(V x, float e) {
  auto rest = static_cast<std::uint32_t>(e * 256.0F + 0.5F);
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

// The way from a surface to a light, and the reciprocals of its length and of what it costs.
struct Ray {
  V x, y, z;
  V length;
  V over_length;
  V share;  // of the light that is left, over the length
};

HWY_INLINE Ray sun_ray(const LightRow& light) {
  const auto& d = light.direction;
  const V one = set(1.0F);
  return {set(-d[0]), set(-d[1]), set(-d[2]), one, one, one};
}

HWY_INLINE Ray aim(const LightRow& light, V px, V py, V pz) {
  const V x = Sub(set(light.position[0]), px);
  const V y = Sub(set(light.position[1]), py);
  const V z = Sub(set(light.position[2]), pz);
  // Not 0: what a light gives stays finite.
  const V length2 = hn::Max(dot(x, y, z, x, y, z), set(1e-12F));
  const V length = hn::Sqrt(length2);
  const auto& a = light.attenuation;
  const V sum = Add(Add(set(a[0]), Mul(set(a[2]), length2)), Mul(set(a[1]), length));
  const V loss = hn::Max(sum, set(1e-9F));
  const V share = Div(set(1.0F), Mul(length, loss));
  return {x, y, z, length, Mul(share, loss), share};
}

// The share of a spot's light in the direction of the ray.
HWY_INLINE V spot_share(const LightRow& light, const Ray& ray) {
  const auto& d = light.direction;
  const V cosine =
      Mul(dot(ray.x, ray.y, ray.z, set(-d[0]), set(-d[1]), set(-d[2])), ray.over_length);
  return hn::IfThenElseZero(hn::Ge(cosine, set(light.cos_cutoff)),
                            power_of_cosine(cosine, light.exponent));
}

// Blinn's highlight: the cosine between the normal and the half of light and view, to a power.
HWY_INLINE V highlight(const PreparedScene& scene, const Block& b, std::size_t at, const Ray& ray) {
  const V x = load(b.x, at);
  const V y = load(b.y, at);
  const V z = load(b.z, at);
  const V view = Div(set(-1.0F), hn::Sqrt(dot(x, y, z, x, y, z)));
  const V hx = Add(Mul(ray.x, ray.over_length), Mul(x, view));
  const V hy = Add(Mul(ray.y, ray.over_length), Mul(y, view));
  const V hz = Add(Mul(ray.z, ray.over_length), Mul(z, view));
  const V length2 = hn::Max(dot(hx, hy, hz, hx, hy, hz), set(1e-20F));
  const V cosine =
      Div(dot(load(b.nx, at), load(b.ny, at), load(b.nz, at), hx, hy, hz), hn::Sqrt(length2));
  const V exponent = of_material(load(b.material, at), scene.materials[0].shininess);
  V result = set(0.0F);
  M rest = hn::Ge(exponent, set(0.0F));
  alignas(64) std::array<float, kMaxLanes> exponents;
  hn::Store(exponent, D(), exponents.data());
  while (!hn::AllFalse(D(), rest)) {
    const float e = exponents[static_cast<std::size_t>(hn::FindFirstTrue(D(), rest))];
    const M same = hn::Eq(exponent, set(e));
    result = hn::IfThenElse(same, power_of_cosine(cosine, e), result);
    rest = hn::AndNot(same, rest);
  }
  return result;
}

// Adds one light to `diffuse` and `specular`; a plain one is a point, has no shadow and is without
// highlights in this block.
template <bool kIsPlain>
HWY_INLINE void add_light(const Shading& shading, const LightRow& row, Block& b) {
  const LightRow light = row;  // which nothing that is stored can change
  const V zero = set(0.0F);
  for (const Block::Vector& vector : b.active()) {
    const std::size_t at = vector.at;
    const V x = load(b.x, at);
    const V y = load(b.y, at);
    const V z = load(b.z, at);
    const Ray ray = !kIsPlain && light.is_directional ? sun_ray(light) : aim(light, x, y, z);
    const V toward = dot(load(b.nx, at), load(b.ny, at), load(b.nz, at), ray.x, ray.y, ray.z);
    V share = ray.share;
    if (!kIsPlain && light.cos_cutoff >= -1.0F) share = Mul(share, spot_share(light, ray));
    if (!kIsPlain && light.shadow >= 0) {
      const auto map = static_cast<std::size_t>(light.shadow);
      share = Mul(share, lit_share(shading.shadows[map], light, x, y, z));
    }
    store(Add(load(b.diffuse, at), Mul(hn::Max(toward, zero), share)), b.diffuse, at);
    if (kIsPlain || !light.has_specular || !vector.is_shiny) continue;
    const V shine = Mul(Mul(share, ray.length), highlight(shading.scene, b, at, ray));
    const V faced = hn::IfThenElseZero(hn::Gt(toward, zero), shine);
    store(Add(load(b.specular, at), faced), b.specular, at);
  }
}

// Adds `diffuse` and `specular`, of the colours of `light`, to the pixels' colours.
HWY_INLINE void colour_light(const PreparedScene& scene, const LightRow& light, Block& b) {
  const MaterialRow& first = scene.materials[0];
  const auto add = [&](const Block::Vector& vector, Block::Plane<float>& amounts, const Rgb& colour,
                       const std::array<float, 3>& own) HWY_ATTR {
    const std::size_t at = vector.at;
    const VI material = load(b.material, at);
    const V amount = load(amounts, at);
    store(set(0.0F), amounts, at);
    const V r = Mul(set(colour[0]), of_material(material, own[0]));
    const V g = Mul(set(colour[1]), of_material(material, own[1]));
    const V blue = Mul(set(colour[2]), of_material(material, own[2]));
    store(Add(load(b.r, at), Mul(amount, r)), b.r, at);
    store(Add(load(b.g, at), Mul(amount, g)), b.g, at);
    store(Add(load(b.b, at), Mul(amount, blue)), b.b, at);
  };
  for (const Block::Vector& vector : b.active()) {
    add(vector, b.diffuse, light.diffuse, first.diffuse);
    if (vector.is_shiny) add(vector, b.specular, light.specular, first.specular);
  }
}

// The colours of a block's surfaces under all lights, before their textures. Light of one colour is
// added up before it is coloured.
HWY_INLINE void light_up(const Shading& shading, const Layer& layer, Block& b) {
  const auto is_shiny = [](const Block::Vector& vector) { return vector.is_shiny; };
  const bool any_shiny = std::any_of(b.active().begin(), b.active().end(), is_shiny);
  for (const LightRow& light : layer.lights) {
    const bool is_plain = !light.is_directional && light.cos_cutoff < -1.0F && light.shadow < 0 &&
                          !(light.has_specular && any_shiny);
    if (is_plain) {
      add_light<true>(shading, light, b);
    } else {
      add_light<false>(shading, light, b);
    }
    if (light.is_last_of_colour) colour_light(shading.scene, light, b);
  }
}

}  // namespace
}  // namespace tether::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
