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

}  // namespace

Vec3 to_enu(const Place& place, const Vec3& v_W) {
  const double s = std::sin(place.heading_rad), c = std::cos(place.heading_rad);
  return {v_W.x * c + v_W.y * s, -v_W.x * s + v_W.y * c, v_W.z};
}

Geodetic geodetic_of(const Place& place, const Vec3& p_W) {
  const double latitude_rad = rad_from_deg(place.latitude_deg);
  const double longitude_rad = rad_from_deg(place.longitude_deg);
  const double sin_lat = std::sin(latitude_rad), cos_lat = std::cos(latitude_rad);
  const double sin_lon = std::sin(longitude_rad), cos_lon = std::cos(longitude_rad);
  const double n_m = prime_vertical_m(sin_lat);
  const Vec3 origin{(n_m + place.elevation_m) * cos_lat * cos_lon,
                    (n_m + place.elevation_m) * cos_lat * sin_lon,
                    (n_m * (1.0 - kEccentricity2) + place.elevation_m) * sin_lat};
  const Vec3 enu = to_enu(place, p_W);
  return geodetic_of_ecef(
      {origin.x - sin_lon * enu.x - sin_lat * cos_lon * enu.y + cos_lat * cos_lon * enu.z,
       origin.y + cos_lon * enu.x - sin_lat * sin_lon * enu.y + cos_lat * sin_lon * enu.z,
       origin.z + cos_lat * enu.y + sin_lat * enu.z});
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
