#include <algorithm>
#include <cmath>

#include <tether/base/units.h>
#include <tether/sim/geodesy.h>

namespace tether::sim {
namespace {

using uav::Vec3;

// WGS 84: equatorial radius [m], and the square of the first eccentricity.
constexpr double kRadius_m = 6378137.0;
constexpr double kFlattening = 1.0 / 298.257223563;
constexpr double kEccentricity2 = kFlattening * (2.0 - kFlattening);

// ISO 2533: sea level, and the lapse rate of the troposphere.
constexpr double kPressure0_Pa = 101325.0;
constexpr double kTemperature0_K = 288.15;
constexpr double kLapse_K_m = 0.0065;
constexpr double kExponent = 9.80665 / (287.05287 * kLapse_K_m);

double prime_vertical_m(double sin_latitude) {
  return kRadius_m / std::sqrt(1.0 - kEccentricity2 * sin_latitude * sin_latitude);
}

// Each round makes the error of the latitude some hundred times smaller.
Geodetic geodetic_of_ecef(const Vec3& p) {
  constexpr int kRounds = 6;
  const double across_m = std::hypot(p.x, p.y);
  double latitude_rad = std::atan2(p.z, across_m * (1.0 - kEccentricity2));
  double altitude_m = 0.0;
  for (int round = 0; round < kRounds; ++round) {
    const double s = std::sin(latitude_rad), c = std::cos(latitude_rad);
    const double n_m = prime_vertical_m(s);
    altitude_m = across_m * c + p.z * s - kRadius_m * kRadius_m / n_m;
    latitude_rad = std::atan2(p.z, across_m * (1.0 - kEccentricity2 * n_m / (n_m + altitude_m)));
  }
  return {deg_from_rad(latitude_rad), deg_from_rad(std::atan2(p.y, p.x)), altitude_m};
}

Vec3 ecef_of(const Geodetic& point) {
  const double latitude_rad = rad_from_deg(point.latitude_deg);
  const double longitude_rad = rad_from_deg(point.longitude_deg);
  const double n_m = prime_vertical_m(std::sin(latitude_rad));
  const double across_m = (n_m + point.altitude_m) * std::cos(latitude_rad);
  return {across_m * std::cos(longitude_rad), across_m * std::sin(longitude_rad),
          (n_m * (1.0 - kEccentricity2) + point.altitude_m) * std::sin(latitude_rad)};
}

// The plane that touches the ellipsoid at a place, in the Earth's own frame.
struct Horizon {
  Vec3 origin, east, north, up;

  explicit Horizon(const Place& place)
      : origin(ecef_of({place.latitude_deg, place.longitude_deg, place.elevation_m})) {
    const double latitude_rad = rad_from_deg(place.latitude_deg);
    const double longitude_rad = rad_from_deg(place.longitude_deg);
    const double sin_lat = std::sin(latitude_rad), cos_lat = std::cos(latitude_rad);
    const double sin_lon = std::sin(longitude_rad), cos_lon = std::cos(longitude_rad);
    east = {-sin_lon, cos_lon, 0.0};
    north = {-sin_lat * cos_lon, -sin_lat * sin_lon, cos_lat};
    up = {cos_lat * cos_lon, cos_lat * sin_lon, sin_lat};
  }
};

}  // namespace

Vec3 to_enu(const Place& place, const Vec3& v_W) {
  const double s = std::sin(place.heading_rad), c = std::cos(place.heading_rad);
  return {v_W.x * c + v_W.y * s, -v_W.x * s + v_W.y * c, v_W.z};
}

Vec3 from_enu(const Place& place, const Vec3& v_ENU) {
  const double s = std::sin(place.heading_rad), c = std::cos(place.heading_rad);
  return {v_ENU.x * c - v_ENU.y * s, v_ENU.x * s + v_ENU.y * c, v_ENU.z};
}

Geodetic geodetic_of(const Place& place, const Vec3& p_W) {
  const Horizon horizon(place);
  const Vec3 enu = to_enu(place, p_W);
  return geodetic_of_ecef(horizon.origin + enu.x * horizon.east + enu.y * horizon.north +
                          enu.z * horizon.up);
}

Vec3 point_of(const Place& place, const Geodetic& point) {
  const Horizon horizon(place);
  const Vec3 p = ecef_of(point) - horizon.origin;
  return from_enu(place, {dot(p, horizon.east), dot(p, horizon.north), dot(p, horizon.up)});
}

// Above the troposphere, as at its top.
double standard_pressure_pa(double altitude_m) {
  const double ratio = 1.0 - kLapse_K_m * std::min(altitude_m, 11'000.0) / kTemperature0_K;
  return kPressure0_Pa * std::pow(ratio, kExponent);
}

double standard_altitude_m(double pressure_Pa) {
  return kTemperature0_K / kLapse_K_m *
         (1.0 - std::pow(std::max(0.0, pressure_Pa) / kPressure0_Pa, 1.0 / kExponent));
}

}  // namespace tether::sim
