#include "exposure.h"
#include "place/lens.h"
#include "place/shadow_map.h"
#include "scene/prepared_scene.h"
#include "shade/shade.h"
#include "strip_renderer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <list>

#include <hwy/targets.h>

#include <tether/base/error.h>
#include <tether/sim_raster/renderer.h>

namespace tether::raster {
namespace {

constexpr std::size_t kLensesKept = 16;
constexpr int kStripsPerThread = 4;

void require(bool condition, const char* what) {
  if (!condition) throw Error(ErrorCode::kUsage, std::string("view: ") + what);
}

bool is_pose(const uav::Pose& X) {
  const double length = X.q.w * X.q.w + X.q.x * X.q.x + X.q.y * X.q.y + X.q.z * X.q.z;
  return std::abs(X.p.x) <= kMaxCoordinate_m && std::abs(X.p.y) <= kMaxCoordinate_m &&
         std::abs(X.p.z) <= kMaxCoordinate_m && std::abs(length - 1.0) < 1e-6;
}

void check(const uav::CameraModel& c) {
  const auto is_size = [](int px) { return px >= 1 && px <= kMaxImageSize_px; };
  require(is_size(c.width_px) && is_size(c.height_px),
          "the image's size is not 1 to 8192 pixels each way");
  const auto is_focal = [](double f) { return f > 1e-4 && f < 1e6; };
  require(is_focal(c.fx_px) && is_focal(c.fy_px),
          "the camera's focal length is not within 0.0001 to 1,000,000 pixels");
  require(std::abs(c.cx_px) < 3e4 && std::abs(c.cy_px) < 3e4,
          "the camera's principal point is not within 30,000 pixels");
  const std::array distortion{c.k1, c.k2, c.k3, c.p1, c.p2};
  require(
      std::all_of(distortion.begin(), distortion.end(), [](double k) { return std::abs(k) < 1e3; }),
      "a distortion coefficient is not finite, or beyond 1000");
}

void check(const View& view, const Scene& scene) {
  check(view.camera);
  require(view.near_m >= 1e-4 && view.far_m > view.near_m && view.far_m <= 1e7,
          "near_m is not at least 0.1 mm, or far_m not beyond it and within 10,000 km");
  require(!view.instants.empty(), "there is no instant");
  const auto is_time = [](double s) { return s >= 0.0 && s <= 1e6; };
  require(is_time(view.exposure_s) && is_time(view.readout_s),
          "exposure_s or readout_s is negative or not finite");
  const double reach_s = view.spacing_s * static_cast<double>(view.instants.size() - 1);
  require(view.instants.size() == 1 || reach_s >= (1.0 - 1e-9) * (view.exposure_s + view.readout_s),
          "the instants do not reach back to the first row's exposure");
  for (const Instant& instant : view.instants) {
    require(instant.X_WB.size() >= scene.bodies() &&
                instant.X_WB.size() == view.instants[0].X_WB.size(),
            "not a pose for each body");
    require(is_pose(instant.X_WC) && std::all_of(instant.X_WB.begin(), instant.X_WB.end(), is_pose),
            "a pose is not finite, beyond 1,000 km, or its quaternion is not unit");
  }
}

// Highway's bits for sets of instructions that this processor has and that pictures are compiled
// for.
std::int64_t usable_targets() {
  return hwy::SupportedTargets() & HWY_TARGETS;
}

void check(const Picture& picture, const uav::CameraModel& c) {
  const std::size_t pixels =
      static_cast<std::size_t>(c.width_px) * static_cast<std::size_t>(c.height_px);
  const auto fits = [](std::size_t size, std::size_t wanted) {
    return size == 0 || size == wanted;
  };
  require(fits(picture.rgb.size(), 3 * pixels) && fits(picture.depth_m.size(), pixels) &&
              fits(picture.entity.size(), pixels),
          "the picture's arrays are not of the image's size");
}

}  // namespace

class Renderer::Work {
 public:
  Work(const Scene& scene, Helpers* helpers) : scene_(scene), helpers_(helpers) {}

  const Lens& lens_of(const uav::CameraModel& camera) {
    const auto known = std::find_if(lenses_.begin(), lenses_.end(),
                                    [&](const Lens& lens) { return lens.camera() == camera; });
    if (known != lenses_.end()) {
      lenses_.splice(lenses_.begin(), lenses_, known);
    } else {
      lenses_.emplace_front(camera);
      if (lenses_.size() > kLensesKept) lenses_.pop_back();
    }
    return lenses_.front();
  }

  void draw(const View& view, const Picture& picture) {
    check(view, scene_);
    check(picture, view.camera);
    update_shadows(view);
    const Lens& lens = lens_of(view.camera);
    const int rows = view.camera.height_px;
    const bool is_exposed = view.instants.size() > 1 && view.exposure_s + view.readout_s > 0.0;
    Sampling sampling;
    if (is_exposed) {
      place_layer(scene_.prepared(), lens, shadows_, view, {0, rows},
                  {0, 0, view.camera.width_px - 1, rows - 1},
                  0.5 * (view.exposure_s + view.readout_s), moment_, middle_);
      sampling = {view, lens, scene_.body_radii_m(), middle_};
    }
    const int threads = helpers_ == nullptr ? 1 : helpers_->threads() + 1;
    const int tile_rows = tiles_in(rows);
    const int wanted = threads == 1 ? 1 : std::min(tile_rows, threads * kStripsPerThread);
    const int strip_rows = sampling.band_rows() > 0 ? sampling.band_rows()
                                                    : (tile_rows + wanted - 1) / wanted * kTile_px;
    const int strips = (rows + strip_rows - 1) / strip_rows;
    const bool is_whole = strips == 1 && is_exposed && !view.antialias;
    const StripRenderer::Job job{
        scene_.prepared(), lens, shadows_, view, picture, sampling, is_whole ? &middle_ : nullptr};
    const auto draw_strip = [&](int i) {
      const int first = i * strip_rows;
      scratch().draw(job, {first, std::min(strip_rows, rows - first)});
    };
    if (threads == 1 || strips == 1) {
      for (int i = 0; i < strips; ++i) draw_strip(i);
    } else {
      helpers_->share(strips, draw_strip);
    }
  }

 private:
  // Memory for one strip at a time, which any renderer may use.
  static StripRenderer& scratch() {
    thread_local StripRenderer of_this_thread;
    return of_this_thread;
  }

  // Shadows are those of the middle of the window.
  void update_shadows(const View& view) {
    if (!scene_.prepared().any_shadow) return;
    if (shadows_.empty()) {
      for (const Light& light : scene_.prepared().lights) {
        if (!light.cast_shadows) continue;
        shadows_.emplace_back(scene_.prepared(), light, ShadowMap::Casters::kFixed);
        shadows_.emplace_back(scene_.prepared(), light, ShadowMap::Casters::kBodies);
      }
    }
    interpolate(view, 0.5 * (view.exposure_s + view.readout_s), moment_);
    for (ShadowMap& map : shadows_) map.update(moment_.X_WB, view.hidden);
  }

  const Scene& scene_;
  Helpers* helpers_;
  std::list<Lens> lenses_;  ///< the last used one first
  std::vector<ShadowMap> shadows_;
  Layer middle_;  ///< of the present picture
  Moment moment_;
};

void check_processor() {
  if (usable_targets() == 0) {
    throw Error(
        ErrorCode::kSetup,
        "this processor lacks the SSSE3 instructions, with which cameras are simulated: use "
        "one of 2006 or later, or give a virtual machine the processor of its host");
  }
}

Renderer::Renderer(const Scene& scene, Helpers* helpers)
    : work_(std::make_unique<Work>(scene, helpers)) {
  check_processor();
}

Renderer::~Renderer() = default;

void Renderer::draw(const View& view, const Picture& picture) {
  work_->draw(view, picture);
}

std::size_t Renderer::blind_pixels(const uav::CameraModel& camera) {
  check(camera);
  return work_->lens_of(camera).blind_pixels();
}

std::string Renderer::instructions() {
  const std::int64_t usable = usable_targets();
  return hwy::TargetName(usable & -usable);
}

std::map<std::uint32_t, PixelBox> visible_boxes(std::span<const std::uint32_t> entity,
                                                int width_px) {
  std::map<std::uint32_t, PixelBox> boxes;
  const auto width = static_cast<std::size_t>(width_px);
  for (std::size_t begin = 0; begin < entity.size();) {
    // Pixels of one entity that are beside each other.
    const std::size_t row = begin / width;
    const std::size_t end = end_of_run(entity.first((row + 1) * width), begin);
    if (entity[begin] != 0) {
      const int y = static_cast<int>(row);
      const int left = static_cast<int>(begin - row * width);
      const int right = left + static_cast<int>(end - begin) - 1;
      PixelBox& box =
          boxes.try_emplace(entity[begin], PixelBox{left, y, right, y, 0}).first->second;
      box = {std::min(box.left, left), box.top, std::max(box.right, right), y,
             box.pixels + end - begin};
    }
    begin = end;
  }
  return boxes;
}

}  // namespace tether::raster
