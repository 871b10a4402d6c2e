#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <tether/base/units.h>
#include <tether/campaign/metrics.h>
#include <tether/uav/camera_model.h>

// An anchor's outline is sampled in its own frame, projected point by point with the camera's lens,
// and bounded by a rectangle.
namespace tether::campaign {
namespace {

// Points along each edge of a box (a lens may bend it) and around each rim or silhouette: the
// rectangle of a circle of 200 px is too small by less than 0.02 px.
constexpr int kEdgePoints = 16;
constexpr int kRimPoints = 256;

uav::Vec3 vec3(const double (&v)[3]) {
  return {v[0], v[1], v[2]};
}
uav::Quat quat(const double (&q)[4]) {
  return {q[0], q[1], q[2], q[3]};
}

// The points that bound the image of an anchor, in its own frame A.

void add_circle(std::vector<uav::Vec3>& points, const uav::Vec3& centre, const uav::Vec3& u,
                const uav::Vec3& v) {
  for (int i = 0; i < kRimPoints; ++i) {
    const double angle_rad = 2.0 * std::numbers::pi * i / kRimPoints;
    points.push_back(centre + std::cos(angle_rad) * u + std::sin(angle_rad) * v);
  }
}

std::vector<uav::Vec3> box_edges_A(const uav::Vec3& size_m) {
  std::vector<uav::Vec3> points;
  for (const double along : {-0.5, 0.5}) {
    for (const double across : {-0.5, 0.5}) {
      for (int i = 0; i <= kEdgePoints; ++i) {
        const double t = static_cast<double>(i) / kEdgePoints - 0.5;
        points.push_back({t * size_m.x, along * size_m.y, across * size_m.z});
        points.push_back({along * size_m.x, t * size_m.y, across * size_m.z});
        points.push_back({along * size_m.x, across * size_m.y, t * size_m.z});
      }
    }
  }
  return points;
}

std::vector<uav::Vec3> cylinder_rims_A(const uav::Vec3& size_m) {
  std::vector<uav::Vec3> points;
  for (const double end : {-0.5, 0.5}) {
    add_circle(points, {0.0, 0.0, end * size_m.z}, {0.5 * size_m.x, 0.0, 0.0},
               {0.0, 0.5 * size_m.x, 0.0});
  }
  return points;
}

// The circle in which the cone of tangents from the eye touches the sphere; empty when the eye is
// inside.
std::vector<uav::Vec3> sphere_silhouette_A(double radius_m, const uav::Vec3& eye_A) {
  const double distance_m = uav::norm(eye_A);
  if (distance_m <= radius_m) return {};
  const uav::Vec3 towards_eye = (1.0 / distance_m) * eye_A;
  const uav::Vec3 aside =
      std::abs(towards_eye.x) < 0.8 ? uav::Vec3{1.0, 0.0, 0.0} : uav::Vec3{0.0, 1.0, 0.0};
  const uav::Vec3 across = uav::cross(towards_eye, aside);
  const double sine = radius_m / distance_m;
  const double rim_m = radius_m * std::sqrt(1.0 - sine * sine);
  const uav::Vec3 u = (rim_m / uav::norm(across)) * across;
  std::vector<uav::Vec3> points;
  add_circle(points, radius_m * sine * towards_eye, u, uav::cross(towards_eye, u));
  return points;
}

std::vector<uav::Vec3> outline_A(const record::Anchor& anchor, const uav::Vec3& eye_A) {
  const uav::Vec3 size_m = vec3(anchor.size_m);
  if (anchor.shape == "box") return box_edges_A(size_m);
  if (anchor.shape == "cylinder") return cylinder_rims_A(size_m);
  if (anchor.shape == "sphere") return sphere_silhouette_A(0.5 * size_m.x, eye_A);
  return {};
}

// Projection.

uav::CameraModel model_of(const record::CameraInfo& camera) {
  return {camera.width_px, camera.height_px, camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px,
          camera.k1,       camera.k2,        camera.k3,    camera.p1,    camera.p2};
}

// Far aside, the polynomials of a distortion fold back into the image; such a pixel is no image of
// the point.
std::optional<uav::Pixel> project(const uav::CameraModel& model, const uav::Vec3& p_C) {
  const std::optional<uav::Pixel> pixel = model.project(p_C);
  if (!pixel || !model.has_distortion()) return pixel;
  const uav::Vec3 back_C = p_C.z * model.unproject(*pixel);
  const uav::Vec3 off_C = back_C - p_C;
  const bool is_its_own = uav::dot(off_C, off_C) < 1e-8 * uav::dot(p_C, p_C);
  return is_its_own ? pixel : std::nullopt;
}

void extend(PixelRect& rect, const uav::Pixel& pixel) {
  rect.left_px = std::min(rect.left_px, pixel.u_px);
  rect.right_px = std::max(rect.right_px, pixel.u_px);
  rect.top_px = std::min(rect.top_px, pixel.v_px);
  rect.bottom_px = std::max(rect.bottom_px, pixel.v_px);
}

PixelRect image_of(const record::CameraInfo& camera) {
  return {-0.5, -0.5, camera.width_px - 0.5, camera.height_px - 0.5};
}

}  // namespace

uav::Pose camera_pose(const record::SensorInfo& camera, const uav::Pose& X_WB) {
  return X_WB * uav::Pose{vec3(camera.camera->p_BS_m), quat(camera.camera->q_BS)};
}

std::optional<PixelRect> true_roi(const record::SensorInfo& camera, const uav::Pose& X_WB,
                                  const record::Anchor& anchor) {
  if (!camera.camera) return std::nullopt;
  const uav::CameraModel model = model_of(*camera.camera);
  const uav::Pose X_WC =
      camera_pose(camera, X_WB) * uav::Pose{uav::Vec3{}, uav::q_body_from_optical()};
  const uav::Pose X_CA = inverse(X_WC) * uav::Pose{vec3(anchor.p_WA_m), quat(anchor.q_WA)};
  std::optional<PixelRect> roi;
  for (const uav::Vec3& p_A : outline_A(anchor, inverse(X_CA).p)) {
    const std::optional<uav::Pixel> pixel = project(model, transform(X_CA, p_A));
    if (!pixel) return std::nullopt;
    if (!roi) roi = PixelRect{pixel->u_px, pixel->v_px, pixel->u_px, pixel->v_px};
    extend(*roi, *pixel);
  }
  return roi;
}

std::optional<PixelRect> roi_in_image(const record::Interaction& read,
                                      const record::SensorInfo& camera, const uav::Pose& X_WB,
                                      const record::Anchor& anchor) {
  const std::optional<PixelRect> whole = true_roi(camera, X_WB, anchor);
  if (!read.seen_anchors) return whole;
  const auto seen = std::ranges::find(*read.seen_anchors, anchor.name, &record::SeenAnchor::anchor);
  if (seen == read.seen_anchors->end()) return std::nullopt;
  const PixelRect pixels{seen->left_px - 0.5, seen->top_px - 0.5, seen->right_px + 0.5,
                         seen->bottom_px + 0.5};
  if (!whole) return pixels;
  // A pixel shows what is in its middle: a visible edge is half a pixel away at most.
  constexpr double kReached_px = 0.75;
  const auto edge = [](double of_whole_px, double of_pixels_px) {
    return std::abs(of_whole_px - of_pixels_px) <= kReached_px ? of_whole_px : of_pixels_px;
  };
  return PixelRect{edge(whole->left_px, pixels.left_px), edge(whole->top_px, pixels.top_px),
                   edge(whole->right_px, pixels.right_px),
                   edge(whole->bottom_px, pixels.bottom_px)};
}

const record::Interaction* find_read(const record::Record& record, const std::string& uav,
                                     const std::string& sensor, std::uint64_t index) {
  for (const auto& logged : record.interactions) {
    const record::Interaction& read = logged.message;
    if (read.kind == record::kSensor && read.uav == uav && read.sensor == sensor &&
        read.sample_index == index && read.sampled_at)
      return &read;
  }
  return nullptr;
}

std::optional<PixelRect> visible_part(const record::SensorInfo& camera, const PixelRect& roi) {
  const PixelRect image = image_of(*camera.camera);
  const PixelRect part{std::max(roi.left_px, image.left_px), std::max(roi.top_px, image.top_px),
                       std::min(roi.right_px, image.right_px),
                       std::min(roi.bottom_px, image.bottom_px)};
  const bool is_empty = part.left_px >= part.right_px || part.top_px >= part.bottom_px;
  return is_empty ? std::nullopt : std::optional(part);
}

bool is_cut(const record::SensorInfo& camera, const PixelRect& roi) {
  return visible_part(camera, roi) != roi;
}

double roi_bearing_rad(const record::SensorInfo& camera, const PixelRect& roi) {
  const uav::CameraModel model = model_of(*camera.camera);
  const uav::Quat q_BC = quat(camera.camera->q_BS) * uav::q_body_from_optical();
  const double v_px = 0.5 * (roi.top_px + roi.bottom_px);
  const auto bearing_at = [&](double u_px) {
    const uav::Vec3 direction_B = rotate(q_BC, model.unproject({u_px, v_px}));
    return std::atan2(direction_B.y, direction_B.x);
  };
  const double left_rad = bearing_at(roi.left_px), right_rad = bearing_at(roi.right_px);
  return wrap_angle_rad(right_rad + 0.5 * wrap_angle_rad(left_rad - right_rad));
}

}  // namespace tether::campaign
