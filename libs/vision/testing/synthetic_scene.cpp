#include <algorithm>
#include <cmath>
#include <limits>

#include <tether/base/random.h>
#include <tether/vision/testing/synthetic_scene.h>

namespace tether::vision::testing {
namespace {

using uav::Vec3;

struct Ray {
  Vec3 origin;
  Vec3 direction;
};

constexpr double kMiss = std::numeric_limits<double>::infinity();

struct Hit {
  double at = kMiss;  // multiple of the ray's direction
  int axis = 0;       // of the face that was hit
};

/// The slab method, in the box's own frame.
Hit intersect(const Ray& ray, const SceneBox& box) {
  const uav::Quat q_BW = inverse(uav::from_axis_angle({0, 0, 1}, box.yaw_rad));
  const Vec3 o = rotate(q_BW, ray.origin - box.p_W);
  const Vec3 d = rotate(q_BW, ray.direction);
  const double origins[] = {o.x, o.y, o.z};
  const double directions[] = {d.x, d.y, d.z};
  const double halves[] = {box.size_m.x / 2, box.size_m.y / 2, box.size_m.z / 2};
  double enter = 0.0;
  double leave = kMiss;
  Hit hit;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (-halves[axis] - origins[axis]) / directions[axis];
    const double b = (halves[axis] - origins[axis]) / directions[axis];
    if (std::min(a, b) > enter) {
      enter = std::min(a, b);
      hit.axis = axis;
    }
    leave = std::min(leave, std::max(a, b));
  }
  if (enter > 0.0 && enter < leave) {
    hit.at = enter;
  }
  return hit;
}

Vec3 color_along(const Ray& ray, const std::vector<SceneBox>& boxes) {
  constexpr double kShade[] = {0.75, 0.9, 1.0};  // of the faces across x, y and z
  const Vec3 wall{0.62, 0.60, 0.58};
  const Vec3 floor{0.45, 0.36, 0.28};
  Vec3 color = ray.direction.z < -0.12 ? floor : wall;
  double nearest = kMiss;
  for (const SceneBox& box : boxes) {
    const Hit hit = intersect(ray, box);
    if (hit.at < nearest) {
      nearest = hit.at;
      color = kShade[hit.axis] * box.color_rgb;
    }
  }
  return color;
}

std::uint8_t to_byte(double value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
}

}  // namespace

uav::CameraSample SyntheticScene::render(const uav::CameraModel& camera, const uav::Pose& X_WC,
                                         std::uint64_t index) const {
  uav::CameraSample image;
  image.index = index;
  image.width_px = camera.width_px;
  image.height_px = camera.height_px;
  image.rgb.reserve(3 * static_cast<std::size_t>(camera.width_px * camera.height_px));
  KeyedRandom random({seed, 0, index});
  const auto noise = [&] { return noise_stddev > 0.0 ? noise_stddev * random.normal() : 0.0; };
  for (int v = 0; v < camera.height_px; ++v) {
    for (int u = 0; u < camera.width_px; ++u) {
      Vec3 sum;
      for (const double dv : {-0.25, 0.25}) {
        for (const double du : {-0.25, 0.25}) {
          const Vec3 d_W = rotate(X_WC.q, camera.unproject({u + du, v + dv}));
          sum = sum + color_along({X_WC.p, d_W}, boxes);
        }
      }
      const Vec3 rgb = (255.0 / 4.0) * sum;
      for (const double value : {rgb.x, rgb.y, rgb.z}) {
        image.rgb.push_back(to_byte(value + noise()));
      }
    }
  }
  return image;
}

uav::Pose level_camera(const uav::Vec3& p_W, double yaw_rad) {
  return {p_W, uav::from_axis_angle({0, 0, 1}, yaw_rad) * uav::q_body_from_optical()};
}

}  // namespace tether::vision::testing
