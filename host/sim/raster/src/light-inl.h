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
#include <cmath>
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
HWY_INLINE V highlight(const PreparedScene& scene, const Block::Run& run, const Cell& c,
                       const Ray& ray) {
  const Normal n = normal_of(run, c);
  const V x = load(c.x);
  const V y = load(c.y);
  const V z = load(c.z);
  const V view = Div(set(-1.0F), hn::Sqrt(dot(x, y, z, x, y, z)));
  const V hx = Add(Mul(ray.x, ray.over_length), Mul(x, view));
  const V hy = Add(Mul(ray.y, ray.over_length), Mul(y, view));
  const V hz = Add(Mul(ray.z, ray.over_length), Mul(z, view));
  const V length2 = hn::Max(dot(hx, hy, hz, hx, hy, hz), set(1e-20F));
  const V cosine = Div(dot(n.x, n.y, n.z, hx, hy, hz), hn::Sqrt(length2));
  const V exponent = of_material(run, c, scene.materials[0].shininess);
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
  const bool is_sun = !kIsPlain && light.is_directional;
  const V zero = set(0.0F);
  const auto along = [&](const Normal& n) HWY_ATTR {
    const auto& to = light.position;
    const auto& d = light.direction;
    return is_sun ? dot(n.x, n.y, n.z, set(-d[0]), set(-d[1]), set(-d[2]))
                  : dot(n.x, n.y, n.z, set(to[0]), set(to[1]), set(to[2]));
  };
  for (const Block::Run& run : b.runs()) {
    V light_along = along(normal_of(run, b.cell(b.all_places[run.first])));
    for (const std::size_t at : b.places(run)) {
      Cell& c = b.cell(at);
      if (run.flat == nullptr) light_along = along(normal_of(run, c));
      const V x = load(c.x);
      const V y = load(c.y);
      const V z = load(c.z);
      const V toward = hn::Max(is_sun ? light_along : Sub(light_along, load(c.distance)), zero);
      // A side that is turned away needs no shadows.
      if (!kIsPlain && hn::AllTrue(D(), hn::Eq(toward, zero))) continue;
      const Ray ray = is_sun ? sun_ray(light) : aim(light, x, y, z);
      V share = ray.share;
      if (!kIsPlain && light.cos_cutoff >= -1.0F) share = Mul(share, spot_share(light, ray));
      if (!kIsPlain && light.shadow >= 0) {
        const Normal n = normal_of(run, c);
        const ShadowMap* map = &shading.shadows[static_cast<std::size_t>(light.shadow)];
        for (const std::array<float, 12>& to_map : light.to_shadow) {
          share = Mul(share, lit_share(*map++, to_map, n, x, y, z));
        }
      }
      store(Add(load(c.diffuse), Mul(toward, share)), c.diffuse);
      if (kIsPlain || !light.has_specular || !run.is_shiny) continue;
      const V shine = Mul(Mul(share, ray.length), highlight(shading.scene, run, c, ray));
      const V faced = hn::IfThenElseZero(hn::Gt(toward, zero), shine);
      store(Add(load(c.specular), faced), c.specular);
    }
  }
}

// Adds `amounts` of a light's colour to the pixels' colours, and clears them. `own` is that of the
// first material.
HWY_INLINE void add_colour(const Block::Run& run, const Rgb& of_light,
                           const std::array<float, 3>& own, Lanes<float> Cell::*amounts, Block& b) {
  const auto colour_of = [&](const Cell& c) HWY_ATTR {
    return Colour{Mul(set(of_light[0]), of_material(run, c, own[0])),
                  Mul(set(of_light[1]), of_material(run, c, own[1])),
                  Mul(set(of_light[2]), of_material(run, c, own[2]))};
  };
  Colour by = colour_of(b.cell(b.all_places[run.first]));
  for (const std::size_t at : b.places(run)) {
    Cell& c = b.cell(at);
    if (run.flat == nullptr) by = colour_of(c);
    Colour sum = colour(c);
    add_to(sum, by, load(c.*amounts));
    store(sum, c);
    store(set(0.0F), c.*amounts);
  }
}

// The colours of a block's surfaces under all lights, before their textures. Light of one colour is
// added up before it is coloured.
HWY_INLINE void light_up(const Shading& shading, const Layer& layer, Block& b) {
  const bool any_shiny =
      std::any_of(b.runs().begin(), b.runs().end(), [](const auto& run) { return run.is_shiny; });
  const MaterialRow& first = shading.scene.materials[0];
  for (const LightRow& light : layer.lights) {
    const bool is_plain = !light.is_directional && light.cos_cutoff < -1.0F && light.shadow < 0 &&
                          !(light.has_specular && any_shiny);
    if (is_plain) {
      add_light<true>(shading, light, b);
    } else {
      add_light<false>(shading, light, b);
    }
    if (!light.is_last_of_colour) continue;
    for (const Block::Run& run : b.runs()) {
      add_colour(run, light.diffuse, first.diffuse, &Cell::diffuse, b);
      if (run.is_shiny) add_colour(run, light.specular, first.specular, &Cell::specular, b);
    }
  }
}

}  // namespace
}  // namespace tether::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
