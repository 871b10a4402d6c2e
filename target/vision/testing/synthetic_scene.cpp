#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include <tether/base/random.h>
#include <tether/vision/testing/synthetic_scene.h>

namespace tether::vision::testing {
namespace {

using uav::Vec3;

constexpr double kMiss = std::numeric_limits<double>::infinity();
constexpr double kEverywhere = kMiss;

/// A box as seen from one place, in the box's own frame B.
struct SeenBox {
  uav::Quat q_BW;
  Vec3 eye_B;
  Vec3 half_m;
  Vec3 color_rgb;
  /// No ray of a pixel outside of these hits it.
  double least_u_px = -kEverywhere, most_u_px = kEverywhere;
  double least_v_px = -kEverywhere, most_v_px = kEverywhere;

  bool is_near(int u, int v) const {
    return u >= least_u_px && u <= most_u_px && v >= least_v_px && v <= most_v_px;
  }
};

/// Where its corners are, unless one is behind the camera, or the lens bends its edges.
void limit(SeenBox& seen, const uav::CameraModel& camera, const uav::Pose& X_WC) {
  if (camera.has_distortion()) return;
  SeenBox near = seen;
  near.least_u_px = near.least_v_px = kEverywhere;
  near.most_u_px = near.most_v_px = -kEverywhere;
  for (const double x : {-seen.half_m.x, seen.half_m.x}) {
    for (const double y : {-seen.half_m.y, seen.half_m.y}) {
      for (const double z : {-seen.half_m.z, seen.half_m.z}) {
        const Vec3 from_eye_B = Vec3{x, y, z} - seen.eye_B;
        const auto at =
            camera.project(rotate(inverse(X_WC.q), rotate(inverse(seen.q_BW), from_eye_B)));
        if (!at) return;
        near.least_u_px = std::min(near.least_u_px, at->u_px - 1.0);
        near.most_u_px = std::max(near.most_u_px, at->u_px + 1.0);
        near.least_v_px = std::min(near.least_v_px, at->v_px - 1.0);
        near.most_v_px = std::max(near.most_v_px, at->v_px + 1.0);
      }
    }
  }
  seen = near;
}

SeenBox seen_by(const uav::CameraModel& camera, const uav::Pose& X_WC, const SceneBox& box) {
  const uav::Quat q_BW = inverse(uav::from_axis_angle({0, 0, 1}, box.yaw_rad));
  SeenBox seen{q_BW, rotate(q_BW, X_WC.p - box.p_W), 0.5 * box.size_m, box.color_rgb};
  limit(seen, camera, X_WC);
  return seen;
}

struct Hit {
  double at = kMiss;  // multiple of the ray's direction
  int axis = 0;       // of the face that was hit
};

/// The slab method.
Hit intersect(const Vec3& direction_W, const SeenBox& box) {
  const Vec3 d = rotate(box.q_BW, direction_W);
  const double origins[] = {box.eye_B.x, box.eye_B.y, box.eye_B.z};
  const double directions[] = {d.x, d.y, d.z};
  const double halves[] = {box.half_m.x, box.half_m.y, box.half_m.z};
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
  if (enter > 0.0 && enter < leave) hit.at = enter;
  return hit;
}

Vec3 color_along(const Vec3& direction_W, const std::vector<SeenBox>& boxes) {
  constexpr double kShade[] = {0.75, 0.9, 1.0};  // of the faces across x, y and z
  const Vec3 wall{0.62, 0.60, 0.58};
  const Vec3 floor{0.45, 0.36, 0.28};
  Vec3 color = direction_W.z < -0.12 ? floor : wall;
  double nearest = kMiss;
  for (const SeenBox& box : boxes) {
    const Hit hit = intersect(direction_W, box);
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
  std::vector<SeenBox> seen, near;
  for (const SceneBox& box : boxes) seen.push_back(seen_by(camera, X_WC, box));
  KeyedRandom random({seed, 0, index});
  const auto noise = [&] { return noise_stddev > 0.0 ? noise_stddev * random.normal() : 0.0; };
  for (int v = 0; v < camera.height_px; ++v) {
    for (int u = 0; u < camera.width_px; ++u) {
      near.clear();
      std::ranges::copy_if(seen, std::back_inserter(near),
                           [&](const SeenBox& box) { return box.is_near(u, v); });
      Vec3 sum;
      for (const double dv : {-0.25, 0.25}) {
        for (const double du : {-0.25, 0.25}) {
          const Vec3 d_W = rotate(X_WC.q, camera.unproject({u + du, v + dv}));
          sum = sum + color_along(d_W, near);
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
