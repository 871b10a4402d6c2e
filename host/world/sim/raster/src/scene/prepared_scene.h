#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <tether/sim_raster/scene.h>

namespace tether::raster {

/// As many floats as any processor's instructions take at once.
inline constexpr std::size_t kMaxLanes = 16;

struct Sphere {
  uav::Vec3 centre;
  double radius_m = 0.0;
};

struct Box {
  uav::Vec3 low, high;

  static constexpr Box none() {
    constexpr double kFar = std::numeric_limits<double>::infinity();
    return {{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
  }
  bool is_empty() const { return low.x > high.x; }
  void include(const Box& more) {
    low = {std::min(low.x, more.low.x), std::min(low.y, more.low.y), std::min(low.z, more.low.z)};
    high = {std::max(high.x, more.high.x), std::max(high.y, more.high.y),
            std::max(high.z, more.high.z)};
  }
  uav::Vec3 centre() const { return 0.5 * (low + high); }
  uav::Vec3 half() const { return 0.5 * (high - low); }
  /// Around its corners.
  Sphere sphere() const { return {centre(), norm(half())}; }
};

/// Triangles of a mesh that follow each other, transformed or culled at once. Meshes tend to have
/// near ones in a row.
struct Cluster {
  static constexpr std::size_t kMaxTriangles = 64;
  static constexpr std::size_t kMaxCorners = 3 * kMaxTriangles;
  std::uint32_t first_corner = 0;  ///< of the first triangle
  std::uint32_t stride = 0;        ///< from a triangle's corner to its next one
  std::uint32_t first_triangle = 0;
  std::uint32_t triangles = 0;
  Sphere bounds;  ///< in V
};

struct VertexLook {
  std::array<float, 3> normal;
  std::array<float, 2> uv;
};

struct PreparedMesh {
  std::uint32_t first_cluster = 0;
  std::uint32_t clusters = 0;
  std::uint32_t first_look = 0;
  std::uint32_t triangles = 0;
  Box box;        ///< in V
  Sphere bounds;  ///< in V
};

/// A material as the shading reads it.
struct MaterialRow {
  std::array<float, 3> base;  ///< emissive + ambient · the scene's
  std::array<float, 3> diffuse;
  std::array<float, 3> specular;
  float shininess;
  float alpha;
  std::int32_t first_level;  ///< of PreparedTextures::levels; 0: no texture
  std::int32_t levels;
  std::int32_t is_shiny;                ///< whether it is specular at all
  float texture_width, texture_height;  ///< of its largest size
};

/// Two texels of a texture, one below the other. Of each channel, the upper one and the lower one:
/// 128 less than their bytes.
struct TexelPair {
  std::array<std::array<std::int8_t, 2>, 4> channels;
};

/// One size of a texture: rows of pairs from row −1 on, of its columns from −1 to its width. So the
/// four texels around any place are two neighbours.
struct LevelRow {
  std::int32_t first_pair;            ///< that of row 0, column 0
  std::int32_t stride;                ///< from a row to the next
  float width_256ths, height_256ths;  ///< [texels/256]
};

/// A texture of a TextureSet.
struct TextureRow {
  std::int32_t width_px, height_px;
  std::int32_t first_level, levels;
  std::int32_t is_transparent;
};

struct PreparedTextures {
  std::vector<TextureRow> rows;
  std::vector<LevelRow> levels;   ///< the first is white; so is one after the last
  std::vector<TexelPair> texels;  ///< empty: somebody else has them
  std::span<const TexelPair> all_texels;
  std::shared_ptr<const void> owner;  ///< of these texels
};

struct PreparedInstance {
  std::uint32_t mesh;
  std::uint32_t material;
  std::int32_t body;         ///< −1: fixed in W
  std::int32_t hidden_with;  ///< a body; −1: never
  std::uint32_t entity;
  std::uint32_t first_primitive;  ///< its triangles are numbered from here, from 1 on
  bool transparent;
  bool cast_shadows;
  uav::Pose X_BV;
  Sphere bounds_B;
};

struct PreparedScene {
  std::vector<float> x, y, z;                           ///< of the clusters' corners, in V
  std::vector<VertexLook> looks;                        ///< of the meshes' vertices
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< looks, from their mesh's first one on
  std::vector<Cluster> clusters;
  std::vector<PreparedMesh> meshes;
  std::vector<MaterialRow> materials;
  std::optional<TextureSet> textures;
  std::span<const TexelPair> texels;  ///< those of `textures`
  std::span<const LevelRow> levels;   ///< likewise
  std::vector<PreparedInstance> instances;
  std::vector<Light> lights;  ///< directions unit
  Rgb background{};
  bool any_transparent = false;
  bool any_shadow = false;  ///< a light and a visual that cast them
  std::vector<double> body_radii_m;
};

/// Appends a mesh's clusters. Leaves out triangles with a vertex twice.
PreparedMesh add_mesh(const Mesh& mesh, PreparedScene& scene);

/// Appends a texture and its smaller versions, each half as large: down to one pixel.
/// @returns how many levels.
std::int32_t add_texture(const Texture& texture, PreparedTextures& out);

/// How many texels `add_texture` adds, or a few more.
std::size_t texels_of(const Texture& texture);

}  // namespace tether::raster
