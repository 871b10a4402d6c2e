#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <tether/uav/math.h>

/// A renderer of triangles in software that gives the same bytes on every machine.
///
/// Plain data in, plain data out: it reads no files and knows no simulator. Frames as in
/// tether/uav/math.h; besides, V is a visual's own frame, and the camera's frame C is the optical
/// one (x right, y down, z ahead).
namespace tether::raster {

/// Red, green, blue of a display, each 0..1.
using Rgb = std::array<float, 3>;

/// Triangles in V, counter-clockwise seen from outside.
struct Mesh {
  struct Vertex {
    std::array<float, 3> position{};  ///< [m]
    std::array<float, 3> normal{};    ///< unit
    std::array<float, 2> uv{};        ///< repetitions of the texture; v runs down the picture
  };
  std::vector<Vertex> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices into `vertices`
};

/// Pixels of a display (sRGB bytes), rows from the top down, each R, G, B, A. Repeated beyond its
/// edges. It is filtered, and made smaller, in the bytes' values.
struct Texture {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint8_t> rgba;
};

struct PreparedTextures;

/// Textures in all the sizes in which they are drawn. Immutable.
class TextureSet {
 public:
  /// @throws Error(kBadFile), with the part as its subject, as Scene does.
  explicit TextureSet(const std::vector<Texture>& textures);

  /// What it consists of, as bytes for the same program. The last array is that of the pixels,
  /// whose values may be any.
  std::vector<std::string_view> arrays() const;
  /// From what `arrays` gave. The pixels stay where they are; `owner` keeps them.
  /// @throws std::invalid_argument if they are other arrays.
  TextureSet(std::span<const std::string_view> arrays, std::shared_ptr<const void> owner);

  std::size_t size() const;
  /// For this library's own sources.
  const PreparedTextures& prepared() const { return *prepared_; }

 private:
  std::shared_ptr<const PreparedTextures> prepared_;  // a scene shares it
};

/// How a surface looks: emissive + ambient·light + Σ(diffuse·light + specular·light), at most 1,
/// times the texture.
struct Material {
  Rgb ambient{0.7F, 0.7F, 0.7F};
  Rgb diffuse{0.7F, 0.7F, 0.7F};
  Rgb specular{};
  Rgb emissive{};
  float alpha = 1.0F;                  ///< times the texture's; transparent below 0.995
  float shininess = 32.0F;             ///< the exponent of Blinn and Phong
  std::optional<std::size_t> texture;  ///< of SceneParts
};

/// One visual of the scene.
struct Instance {
  std::size_t mesh = 0;                      ///< of SceneParts
  std::size_t material = 0;                  ///< of SceneParts
  std::optional<std::size_t> body;           ///< the moving body that it is fixed to; none: W
  uav::Pose X_BV;                            ///< in its body, or in W
  bool cast_shadows = true;                  ///< opaque surfaces only
  std::uint32_t entity = 0;                  ///< written to Picture::entity; 0 is the background
  std::optional<std::size_t> hidden_with{};  ///< the body with which it is hidden; none: its own
};

enum class LightKind { kPoint, kDirectional, kSpot };

struct Light {
  LightKind kind = LightKind::kPoint;
  uav::Vec3 p_WL;
  uav::Vec3 direction_W{0.0, 0.0, -1.0};  ///< need not be unit
  Rgb diffuse{1.0F, 1.0F, 1.0F};
  Rgb specular{};
  /// Of points and spots: 1 / (constant + linear·d + quadratic·d²), d in metres.
  float attenuation_constant = 1.0F, attenuation_linear = 0.0F, attenuation_quadratic = 0.0F;
  double spot_half_angle_rad = 0.4;  ///< 0..π/2
  float spot_exponent = 0.0F;        ///< of the cosine of the angle off the direction
  bool cast_shadows = false;         ///< not of points
};

/// The plain data of a scene.
struct SceneParts {
  std::vector<Mesh> meshes;
  std::vector<Texture> textures;
  std::optional<TextureSet> texture_set{};  ///< in place of `textures`
  std::vector<Material> materials;
  std::vector<Instance> instances;
  std::vector<Light> lights;
  Rgb ambient{0.4F, 0.4F, 0.4F};
  Rgb background{0.7F, 0.7F, 0.7F};
};

inline constexpr std::size_t kMaxTriangles = 10'000'000;  ///< of all instances together
inline constexpr std::size_t kMaxInstances = 1'000'000;
inline constexpr std::size_t kMaxBodies = 100'000;
inline constexpr std::size_t kMaxLights = 32;
inline constexpr int kMaxTextureSize_px = 8192;
inline constexpr std::size_t kMaxTexels = std::size_t{1} << 26;  ///< of all textures
/// How far from its origin a vertex, a visual or a light may be.
inline constexpr double kMaxCoordinate_m = 1e6;

struct PreparedScene;

/// A scene ready to be drawn. Immutable: any number of renderers and threads may use it.
class Scene {
 public:
  /// @throws Error(kBadFile), with the part as its subject ("mesh 3"), for numbers that are not
  /// finite or beyond the limits, and indices out of range.
  /// Triangles without area are left out.
  explicit Scene(const SceneParts& parts);
  ~Scene();
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;

  /// How many poses of bodies a view must have.
  std::size_t bodies() const;
  /// How far each body's visuals reach from its origin [m].
  const std::vector<double>& body_radii_m() const;
  /// For this library's own sources.
  const PreparedScene& prepared() const { return *prepared_; }

 private:
  std::unique_ptr<const PreparedScene> prepared_;
};

}  // namespace tether::raster
