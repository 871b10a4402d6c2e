#pragma once

#include "place/lens.h"
#include "scene/prepared_scene.h"

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

/// The 1/depth of a triangle as a plane over the picture [1/m]: value + along_x·(x−x_ref) +
/// along_y·(y−y_ref), in pixels, and that of its corners.
struct DepthPlane {
  float x_ref, y_ref;
  std::array<float, 3> plane;  ///< value, along_x, along_y
  float low, high;
};

/// A triangle in the picture. It covers the pixels with a·x + b·y + c ≥ 0 for all three edges, x
/// and y in kSubpixels. Exact: a pixel on an edge belongs to just one of the two triangles there.
struct Coverage {
  std::array<std::int32_t, 3> a, b;
  std::array<std::int64_t, 3> c;
  PixelRect pixels;  ///< no other is covered
  DepthPlane depth;
  std::array<std::array<float, 3>, 3> corners;  ///< in C [m]
  std::uint32_t primitive;  ///< the same triangle has the same number in all layers
  std::uint32_t visual;     ///< of Layer::visuals
  std::uint32_t triangle;   ///< of PreparedScene::triangles
};

/// What the triangles of an instance share.
struct PlacedVisual {
  std::array<float, 9> rotation;  ///< from V to C, row by row
  std::uint32_t first_look;
  std::uint32_t material;
  std::uint32_t entity;
};

/// The surface of a triangle as planes over the picture, like its depth. Texture coordinates are
/// those of corner 1, and what is added to them.
struct alignas(32) Facet {
  DepthPlane depth;
  std::array<float, 3> second, third;  ///< weights of the second and third corner, over z
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
  bool is_flat;                                ///< the normal is the same everywhere
  std::uint32_t material;
};

/// The edges of a triangle that part a rectangle's samples, as bits.
struct Reach {
  bool is_none;  ///< one edge is beyond them all
  unsigned edges;
};
/// Of those in `edges` only: all samples are inside of the others.
Reach reach(const Coverage& triangle, const FixedRect& rect, unsigned edges);

/// The most 1/depth over a rectangle [1/m].
float most_inverse_depth(const DepthPlane& depth, const FixedRect& rect);

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

  std::vector<Coverage> coverage;  ///< filled by `place_triangles`, in the order of primitives
  std::vector<PlacedVisual> visuals;
  /// Of each tile, those whose bounds overlap those of its samples: first the opaque ones.
  std::vector<std::vector<std::uint32_t>> opaque, transparent;
  std::vector<LightRow> lights;
  bool only_points = false;   ///< the lights are points without shadows
  bool any_specular = false;  ///< of the lights

  /// Of what a pixel sees, by its id: 1 + a triangle's place in `coverage`, or 0.
  std::uint32_t entity_of(std::uint32_t id) const {
    return id == 0 ? 0 : visuals[coverage[id - 1].visual].entity;
  }

  std::vector<std::uint32_t> keys;  ///< of each triangle, set by `set_keys`

  /// Made when a triangle is shaded first: few of those of a layer are. Not safe from two threads.
  /// Holds until the next triangles are placed.
  const Facet& facet(const PreparedScene& scene, std::size_t triangle) const;
  void clear_facets();

 private:
  mutable std::vector<std::uint32_t> facet_of_;  // 1 + the place in facets_ of each triangle's
  mutable std::vector<Facet> facets_;
};

/// A triangle of the scene.
struct Primitive {
  std::uint32_t number;
  std::uint32_t entity;
};

/// Gives each triangle that is placed in any of the layers a key, which is the same in all of them:
/// 1 + its place in `primitives`.
void set_keys(std::span<Layer> layers, std::vector<Primitive>& primitives);

/// Rows of the picture that one worker draws at once.
struct Strip {
  int first_row = 0;
  int rows = 0;
};

/// What to place.
struct Selection {
  static constexpr int kAll = std::numeric_limits<int>::max();
  PixelRect pixels = {0, 0, kAll, kAll};  ///< only what these may see
  std::optional<std::size_t> hidden;      ///< not this body
  bool only_casters = false;              ///< no visual that casts no shadow
  bool only_fixed = false;                ///< no visual of a body
  bool only_moving = false;               ///< only visuals of bodies
  bool both_sides = false;                ///< back faces as well
};

/// Fills `layer.coverage`, `.visuals` and the tiles' lists, row by row from the strip's first, with
/// the triangles that may be seen in the strip. Their values do not depend on the strip.
void place_triangles(const PreparedScene& scene, const Lens& lens, const Strip& strip,
                     const Selection& selection, Layer& layer);

/// How many tiles so many pixels in a row or a column take.
constexpr int tiles_in(int px) {
  return (px + kTile_px - 1) / kTile_px;
}
inline int tiles_across(const Lens& lens) {
  return tiles_in(lens.camera().width_px);
}

}  // namespace tether::raster
