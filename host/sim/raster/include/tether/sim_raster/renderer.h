#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include <tether/sim_raster/scene.h>
#include <tether/uav/camera_model.h>
#include <tether/uav/math.h>

namespace tether::raster {

/// Where everything is at one moment.
struct Instant {
  uav::Pose X_WC;                   ///< the camera's optical frame
  std::span<const uav::Pose> X_WB;  ///< one for each of Scene::bodies()
};

/// The camera and the moments of a picture.
///
/// With a single instant the picture is of that moment. With several, evenly spaced over
/// exposure_s + readout_s and the last at its end, row r of H gathers light during
/// [e − exposure_s, e] with e = end − readout_s·(H−1−r)/(H−1). Poses in between are interpolated.
/// Light is averaged as light, not as sRGB bytes.
struct View {
  uav::CameraModel camera;
  double near_m = 0.05;  ///< nothing nearer or farther is drawn, along the camera's axis
  double far_m = 100.0;
  std::span<const Instant> instants;
  double exposure_s = 0.0;
  double readout_s = 0.0;
  std::optional<std::size_t> hidden;  ///< a body that is not drawn
  /// Computes the coverage of edges from four samples in each pixel. A surface is still shaded
  /// once in each pixel.
  bool antialias = false;
};

/// The arrays that a picture is written to: height × width entries, rows from the top down. An
/// empty array is not written.
/// Depth and entities are of opaque surfaces, in the middle of each row's exposure.
struct Picture {
  std::span<std::uint8_t> rgb;  ///< three bytes for each pixel
  /// Along the camera's axis [m]. As in REP 117 and 118: +∞ where nothing is within
  /// `depth_max_m` and View::far_m, −∞ where something is between View::near_m and `depth_min_m`,
  /// NaN where the lens sees nothing.
  std::span<float> depth_m;
  std::span<std::uint32_t> entity;  ///< Instance::entity; 0: background
  float depth_min_m = 0.0F;
  float depth_max_m = 1e9F;
};

inline constexpr int kMaxImageSize_px = 8192;  ///< each way
inline constexpr int kMaxThreads = 256;

/// Draws pictures of a scene.
///
/// The same scene and view give the same bytes, whatever was drawn before, on any processor and
/// with any number of threads. Used from one thread at a time.
class Renderer {
 public:
  /// Draws on `threads` threads, the caller's among them. `scene` must outlive this object.
  /// @throws Error(kUsage) for no thread or more than kMaxThreads.
  explicit Renderer(const Scene& scene, int threads = 1);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// @throws Error(kUsage) for a view that cannot be drawn: an image of no size or beyond
  /// kMaxImageSize_px, numbers that are not finite, near_m ≤ 0 or ≥ far_m, no instant, too few
  /// poses, spans of the wrong length, or a lens that sees 32000 pixels off its axis.
  void draw(const View& view, const Picture& picture);

  /// Pixels of a camera that its distortion maps no direction to: strong barrel distortion folds
  /// back on itself before it reaches the corners. They are black.
  std::size_t blind_pixels(const uav::CameraModel& camera);

  /// The processor's instructions that are used, for the record: "AVX2".
  static std::string instructions();

 private:
  class Work;
  std::unique_ptr<Work> work_;
};

/// The pixels in which an entity is seen: first and last column and row.
struct PixelBox {
  int left, top, right, bottom;
  std::size_t pixels;  ///< how many there are
  friend bool operator==(const PixelBox&, const PixelBox&) = default;
};

/// Of each entity of a picture but the background.
std::map<std::uint32_t, PixelBox> visible_boxes(std::span<const std::uint32_t> entity,
                                                int width_px);

}  // namespace tether::raster
