#pragma once

#include <numbers>

namespace tether {

/// Degrees appear only where a person reads or writes them.
constexpr double rad_from_deg(double deg) {
  return deg * (std::numbers::pi / 180.0);
}
constexpr double deg_from_rad(double rad) {
  return rad * (180.0 / std::numbers::pi);
}

/// The same angle in (−π, π].
double wrap_angle_rad(double angle_rad);

}  // namespace tether
