#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>

#include <tether/sim_raster/scene.h>
#include <tether/sim_raster/view.h>
#include <tether/uav/camera_model.h>

namespace tether::raster {

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
