#pragma once

#include "lens.h"
#include "prepared_scene.h"

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace tether::raster {

/// Tiles are squares of this edge length, smaller at the edges of the drawn rows. Their pixels are
/// kept in rows of this many.
inline constexpr int kTile_px = 32;
inline constexpr std::size_t kTilePixels = std::size_t{kTile_px} * kTile_px;

/// The three edges of a triangle. It covers the pixels with a·x + b·y + c ≥ 0 for all three edges,
/// x and y in kSubpixels. Exact: a pixel on an edge belongs to just one of the two triangles there.
struct Coverage {
  std::array<std::int32_t, 3> a, b;
  std::array<std::int64_t, 3> c;
  PixelRect pixels;  ///< no other is covered
};

/// The surface of a triangle as planes over the picture: p(x, y) = p0 + px·(x−x_ref) +
/// py·(y−y_ref), in pixels. Texture coordinates are those of corner 1, and what is added to them.
struct alignas(32) Facet {
  float x_ref, y_ref;
  std::array<float, 3> inverse_depth;  ///< 1/z: value, and change along x and y [1/m]
  std::array<float, 3> second, third;  ///< weights of the second and third corner, over z
  float inverse_depth_low, inverse_depth_high;
  struct Coordinate {
    float first;                 ///< of corner 1
    std::array<float, 3> added;  ///< over z
    float low, high;             ///< of what is added
    /// In texels of the texture's largest size, along x and y: the change of what is added, over z,
    /// and that of 1/z for one repetition.
    std::array<float, 2> change, shrinkage;
  };
  Coordinate u, v;
  std::array<std::array<float, 3>, 3> normal;  ///< in C: of corner 1; corners 2 and 3 less that
  std::int32_t is_flat;                        ///< −1: the normal is the same everywhere; else 0
  std::uint32_t material;
  std::uint32_t primitive;  ///< the same triangle has the same number in all layers
  std::uint32_t entity;
};

/// A light as the shading reads it, in C.
struct LightRow {
  /// A number for each pixel of a vector.
  struct alignas(64) Splat : std::array<float, kMaxLanes> {};

  std::array<Splat, 3> position{}, direction{}, diffuse{}, specular{};
  std::array<Splat, 3> attenuation{};  ///< the first at least 1e-9
  float cos_cutoff = -2.0F;
  float exponent = 0.0F;
  bool is_directional = false;
  bool has_specular = false;
  bool is_last_of_colour = true;  ///< the next light is of another colour, or there is none
  /// The first of its two shadow maps; none: -1.
  std::int32_t shadow = -1;
  /// From C to their pictures: rows of u·z, v·z and z.
  std::array<std::array<float, 12>, 2> to_shadow{};
};

/// The picture's geometry: z = 1 is seen at (f·x + c).
struct Projection {
  double fx, fy, cx, cy;  ///< [px]
  double near_m;
};

/// The scene at one moment, for some rows of the picture.
struct Layer {
  uav::Pose X_CW;
  std::vector<uav::Pose> X_WB;
  Projection projection{};
  double offset_x_px = 0.0, offset_y_px = 0.0;  ///< how far things are moved, for antialiasing

  std::vector<Coverage> coverage;  ///< filled by `place_triangles`
  std::vector<Facet> facets;       ///< as many
  /// Of each tile, those that may be seen in it: first the opaque ones.
  std::vector<std::vector<std::uint32_t>> opaque, transparent;
  std::vector<LightRow> lights;
  bool only_points = false;   ///< the lights are points without shadows
  bool any_specular = false;  ///< of the lights
};

/// Rows of the picture that one worker draws at once.
struct Strip {
  int first_row = 0;
  int rows = 0;
};

/// Which visuals to place.
struct Selection {
  std::optional<std::size_t> hidden;  ///< not this body
  bool only_casters = false;          ///< no visual that casts no shadow
  bool only_fixed = false;            ///< no visual of a body
  bool only_moving = false;           ///< only visuals of bodies
  bool both_sides = false;            ///< back faces as well
};

/// Fills `layer.coverage`, `.facets` and the tiles' lists, row by row from the strip's first, with
/// the triangles that may be seen in the strip. Their values do not depend on the strip.
void place_triangles(const PreparedScene& scene, const Lens& lens, const Strip& strip,
                     const Selection& selection, Layer& layer);

inline int tiles_across(const Lens& lens) {
  return (lens.camera().width_px + kTile_px - 1) / kTile_px;
}

}  // namespace tether::raster
