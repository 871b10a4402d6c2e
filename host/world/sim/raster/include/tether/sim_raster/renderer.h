#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tether/sim_raster/scene.h>
#include <tether/uav/camera_model.h>
#include <tether/uav/math.h>

/// What a picture is to show, and where it goes. Pure functions of values; safe from any thread.
namespace tether::raster {

/// Where everything is at one moment.
struct Instant {
  uav::Pose X_WC;                   ///< the camera's optical frame
  std::span<const uav::Pose> X_WB;  ///< one for each of Scene::bodies()
};

/// The camera and the moments of a picture.
///
/// Row r of H gathers light during [e − exposure_s, e] with e = end − readout_s·(H−1−r)/(H−1). The
/// last instant is that end; the others are each spacing_s before the next, and the first is not
/// after the beginning, except that a single instant is one at which everything rests. Poses in
/// between are interpolated. Light is averaged as light, not as sRGB bytes.
struct View {
  uav::CameraModel camera;
  double near_m = 0.05;  ///< nothing nearer or farther is drawn, along the camera's axis
  double far_m = 100.0;
  std::span<const Instant> instants;
  double spacing_s = 0.0;
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

/// Where everything is at one time of a view.
struct Moment {
  uav::Pose X_WC;
  std::vector<uav::Pose> X_WB;
};

/// Where among the instants, counted from 0, so long before the end of the view is; before the
/// first one, or after the last: there.
double place_among_instants(const View& view, double before_end_s);

/// So long before the end of the view; outside of its instants, at the first or the last.
void interpolate(const View& view, double before_end_s, Moment& moment);

/// How far things move in the picture from the beginning of the first row's exposure to the end of
/// the last row's, near its middle, were they as fast throughout as between the two instants that
/// differ most. At the edges of a wide picture it is up to twice that. No body reaches farther from
/// its origin than its radius, and nothing seen is nearer than `nearest_m`.
double motion_px(const View& view, std::span<const double> body_radii_m, double nearest_m);

/// The same for the surface of one body alone, seen by a camera at rest.
double body_motion_px(const View& view, std::size_t body, double radius_m);

inline constexpr int kMaxImageSize_px = 8192;  ///< each way

/// Other threads that can draw parts of a picture.
class Helpers {
 public:
  using Part = std::function<void(int part)>;

  virtual ~Helpers() = default;
  Helpers(const Helpers&) = delete;
  Helpers& operator=(const Helpers&) = delete;

  /// How many there are; they may be busy.
  virtual int threads() const = 0;
  /// Calls `draw` with 0 to count − 1, on the calling thread and on those that are idle. Returns
  /// when all parts are done. Throws the first exception of a part; parts that nobody has begun
  /// are then left out.
  virtual void share(int count, const Part& draw) = 0;

 protected:
  Helpers() = default;
};

/// @throws Error(kSetup) on a processor without the instructions that pictures and their noise
/// need.
void check_processor();

/// Draws pictures of a scene.
///
/// The same scene and view give the same bytes, whatever was drawn before, on any processor and
/// with any number of threads. Used from one thread at a time.
class Renderer {
 public:
  /// Draws on the calling thread, with `helpers` if there are any. Both must outlive this object.
  /// @throws what check_processor does.
  explicit Renderer(const Scene& scene, Helpers* helpers = nullptr);
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
