#include <cmath>
#include <limits>

#include <tether/uav/camera_model.h>

namespace tether::uav {
namespace {

constexpr int kMaxIterations = 20;
constexpr double kConverged = 1e-12;  // in units of the image plane at z = 1

struct PlanePoint {
  double x = 0.0, y = 0.0;  // at z = 1
};

/// The Brown-Conrady map of an ideal point, with its Jacobian (which is symmetric).
struct Distorted {
  PlanePoint point;
  double dx_dx = 1.0, dx_dy = 0.0, dy_dy = 1.0;
};

Distorted distort(const CameraModel& m, const PlanePoint& ideal) {
  const auto [x, y] = ideal;
  const double r2 = x * x + y * y;
  const double radial = 1.0 + r2 * (m.k1 + r2 * (m.k2 + r2 * m.k3));
  const double slope = m.k1 + r2 * (2.0 * m.k2 + r2 * 3.0 * m.k3);  // d radial / d r²

  Distorted d;
  d.point.x = x * radial + 2.0 * m.p1 * x * y + m.p2 * (r2 + 2.0 * x * x);
  d.point.y = y * radial + m.p1 * (r2 + 2.0 * y * y) + 2.0 * m.p2 * x * y;
  d.dx_dx = radial + 2.0 * x * x * slope + 2.0 * m.p1 * y + 6.0 * m.p2 * x;
  d.dx_dy = 2.0 * x * y * slope + 2.0 * m.p1 * x + 2.0 * m.p2 * y;
  d.dy_dy = radial + 2.0 * y * y * slope + 6.0 * m.p1 * y + 2.0 * m.p2 * x;
  return d;
}

/// Newton's method on the map above, from the distorted point itself.
PlanePoint undistort(const CameraModel& m, const PlanePoint& distorted) {
  PlanePoint ideal = distorted;
  for (int i = 0; i < kMaxIterations; ++i) {
    const Distorted d = distort(m, ideal);
    const double ex = distorted.x - d.point.x;
    const double ey = distorted.y - d.point.y;
    if (std::abs(ex) < kConverged && std::abs(ey) < kConverged) {
      break;
    }
    const double det = d.dx_dx * d.dy_dy - d.dx_dy * d.dx_dy;
    ideal.x += (d.dy_dy * ex - d.dx_dy * ey) / det;
    ideal.y += (d.dx_dx * ey - d.dx_dy * ex) / det;
  }
  return ideal;
}

/// How far off the axis, at z = 1, the radial distortion goes on outwards.
double fold_radius(const CameraModel& m) {
  constexpr double kStep = 1e-3;
  constexpr double kWidest = 20.0;
  for (double r = 0.0; m.has_distortion() && r < kWidest; r += kStep) {
    const double r2 = r * r;
    if (1.0 + r2 * (3.0 * m.k1 + r2 * (5.0 * m.k2 + r2 * 7.0 * m.k3)) <= 0.0) return r;
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace

CameraModel CameraModel::from_horizontal_fov(int width_px, int height_px,
                                             double horizontal_fov_rad) {
  CameraModel m;
  m.width_px = width_px;
  m.height_px = height_px;
  m.fx_px = 0.5 * width_px / std::tan(0.5 * horizontal_fov_rad);
  m.fy_px = m.fx_px;
  m.cx_px = 0.5 * (width_px - 1);
  m.cy_px = 0.5 * (height_px - 1);
  return m;
}

double CameraModel::horizontal_fov_rad() const {
  const Vec3 left = unproject({-0.5, cy_px});
  const Vec3 right = unproject({width_px - 0.5, cy_px});
  return std::atan(right.x) - std::atan(left.x);
}

bool CameraModel::has_distortion() const {
  return k1 != 0.0 || k2 != 0.0 || k3 != 0.0 || p1 != 0.0 || p2 != 0.0;
}

std::optional<Pixel> CameraModel::project(const Vec3& p_C) const {
  if (!(p_C.z > 0.0)) {
    return std::nullopt;
  }
  const PlanePoint seen = distort(*this, {p_C.x / p_C.z, p_C.y / p_C.z}).point;
  return Pixel{fx_px * seen.x + cx_px, fy_px * seen.y + cy_px};
}

Vec3 CameraModel::unproject(const Pixel& pixel) const {
  const PlanePoint seen{(pixel.u_px - cx_px) / fx_px, (pixel.v_px - cy_px) / fy_px};
  const PlanePoint ideal = has_distortion() ? undistort(*this, seen) : seen;
  return {ideal.x, ideal.y, 1.0};
}

bool CameraModel::contains(const Pixel& pixel) const {
  return pixel.u_px >= -0.5 && pixel.u_px < width_px - 0.5 && pixel.v_px >= -0.5 &&
         pixel.v_px < height_px - 0.5;
}

PixelRays::PixelRays(const CameraModel& camera)
    : camera_(camera), fold_radius_(fold_radius(camera)) {}

std::optional<Vec3> PixelRays::at(const Pixel& pixel) const {
  constexpr double kSame_px = 0.01;
  const Vec3 p = camera_.unproject(pixel);
  const Pixel seen = *camera_.project(p);
  const double du = seen.u_px - pixel.u_px;
  const double dv = seen.v_px - pixel.v_px;
  const bool is_same = du * du + dv * dv < kSame_px * kSame_px;
  if (!is_same || p.x * p.x + p.y * p.y > fold_radius_ * fold_radius_) return std::nullopt;
  return p;
}

double bearing_rad(const CameraModel& model, const Pixel& pixel) {
  return -std::atan(model.unproject(pixel).x);
}

}  // namespace tether::uav
