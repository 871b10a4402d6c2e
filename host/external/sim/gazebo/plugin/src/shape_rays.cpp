#include <algorithm>
#include <cmath>
#include <limits>

#include <tether/sim_gazebo_plugin/shape_rays.h>

namespace tether::gazebo_plugin {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The stretch of a ray's line that lies within a convex shape.
struct Stretch {
  double begin_m = -kInfinity;
  double end_m = kInfinity;

  Stretch within(const Stretch& other) const {
    return {std::max(begin_m, other.begin_m), std::min(end_m, other.end_m)};
  }
  // The first surface ahead.
  double ahead_m() const {
    if (begin_m > end_m || end_m < 0.0) return kInfinity;
    return begin_m >= 0.0 ? begin_m : end_m;
  }
};

constexpr Stretch kNowhere{kInfinity, -kInfinity};

// Between two planes at ±half, of the coordinate that begins at `x` and grows by `dx`.
Stretch between(double x, double dx, double half) {
  if (dx == 0.0) return std::abs(x) <= half ? Stretch{} : kNowhere;
  const double a = (-half - x) / dx;
  const double b = (half - x) / dx;
  return {std::min(a, b), std::max(a, b)};
}

// Where a·t² + 2b·t + c ≤ 0.
Stretch below_zero(double a, double b, double c) {
  if (a == 0.0) return c <= 0.0 ? Stretch{} : kNowhere;
  const double discriminant = b * b - a * c;
  if (discriminant < 0.0) return kNowhere;
  const double root = std::sqrt(discriminant);
  return {(-b - root) / a, (-b + root) / a};
}

}  // namespace

double distance_to_box_m(const Ray& ray, const uav::Vec3& size_m) {
  const auto& [p, d] = ray;
  return between(p.x, d.x, 0.5 * size_m.x)
      .within(between(p.y, d.y, 0.5 * size_m.y))
      .within(between(p.z, d.z, 0.5 * size_m.z))
      .ahead_m();
}

double distance_to_sphere_m(const Ray& ray, double radius_m) {
  const auto& [p, d] = ray;
  return below_zero(dot(d, d), dot(p, d), dot(p, p) - radius_m * radius_m).ahead_m();
}

double distance_to_cylinder_m(const Ray& ray, double radius_m, double length_m) {
  const auto& [p, d] = ray;
  return below_zero(d.x * d.x + d.y * d.y, p.x * d.x + p.y * d.y,
                    p.x * p.x + p.y * p.y - radius_m * radius_m)
      .within(between(p.z, d.z, 0.5 * length_m))
      .ahead_m();
}

}  // namespace tether::gazebo_plugin
