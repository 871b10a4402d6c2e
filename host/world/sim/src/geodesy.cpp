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

// IGRF-14 at 2025.0 [nT], Schmidt semi-normalised, by degree and order, and the radius that it
// refers to.
constexpr int kDegrees = 5;
constexpr double kReferenceRadius_m = 6'371'200.0;
constexpr double kG_nT[kDegrees][kDegrees + 1] = {{-29350.0, -1410.3},
                                                  {-2556.2, 2950.9, 1648.7},
                                                  {1360.9, -2404.2, 1243.8, 453.4},
                                                  {894.7, 799.6, 55.8, -281.1, 12.0},
                                                  {-232.9, 369.0, 187.2, -138.7, -141.9, 20.9}};
constexpr double kH_nT[kDegrees][kDegrees + 1] = {{0.0, 4545.5},
                                                  {0.0, -3133.6, -814.2},
                                                  {0.0, -56.9, 237.6, -549.6},
                                                  {0.0, 278.6, -134.0, 212.0, -375.4},
                                                  {0.0, 45.3, 220.0, -122.9, 42.9, 106.2}};

}  // namespace

// The gradient of the potential, in the directions up, south and east of the sphere. `p` are
// Schmidt's functions of the colatitude and `dp` their derivatives, each from those of the two
// degrees below.
Vec3 earth_field_T(const Place& place) {
  constexpr double kTesla = 1e-9;
  constexpr double kNextToThePole = 1e-9;
  const Horizon horizon(place);
  const Vec3 p_E = horizon.origin;
  const double r_m = norm(p_E);
  const double c = p_E.z / r_m;
  const double s = std::max(std::hypot(p_E.x, p_E.y) / r_m, kNextToThePole);
  const double longitude_rad = rad_from_deg(place.longitude_deg);
  double p[kDegrees + 1][kDegrees + 1] = {{1.0}}, dp[kDegrees + 1][kDegrees + 1] = {};
  double up = 0.0, south = 0.0, east = 0.0;
  for (int n = 1; n <= kDegrees; ++n) {
    const double share = std::pow(kReferenceRadius_m / r_m, n + 2);
    for (int m = 0; m <= n; ++m) {
      if (m == n) {
        const double f = n == 1 ? 1.0 : std::sqrt((2.0 * n - 1.0) / (2.0 * n));
        p[n][n] = f * s * p[n - 1][n - 1];
        dp[n][n] = f * (c * p[n - 1][n - 1] + s * dp[n - 1][n - 1]);
      } else {
        const double below = n == 1 ? 0.0 : std::sqrt((n - 1.0) * (n - 1.0) - m * m);
        const double f = std::sqrt(1.0 * n * n - m * m);
        const int last = std::max(n - 2, 0);  // of degree 1, it counts 0 times
        p[n][m] = ((2.0 * n - 1.0) * c * p[n - 1][m] - below * p[last][m]) / f;
        dp[n][m] =
            ((2.0 * n - 1.0) * (c * dp[n - 1][m] - s * p[n - 1][m]) - below * dp[last][m]) / f;
      }
      const double cosine = std::cos(m * longitude_rad), sine = std::sin(m * longitude_rad);
      const double g = kG_nT[n - 1][m], h = kH_nT[n - 1][m];
      up += share * (n + 1) * (g * cosine + h * sine) * p[n][m];
      south -= share * (g * cosine + h * sine) * dp[n][m];
      east += share * m * (g * sine - h * cosine) * p[n][m] / s;
    }
  }
  const Vec3 up_E = (1.0 / r_m) * p_E;
  const Vec3 south_E = cross(horizon.east, up_E);
  const Vec3 field_E = up * up_E + south * south_E + east * horizon.east;
  return kTesla *
         Vec3{dot(field_E, horizon.east), dot(field_E, horizon.north), dot(field_E, horizon.up)};
}

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
