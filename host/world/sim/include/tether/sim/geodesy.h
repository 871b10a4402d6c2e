#pragma once

#include <tether/sim/world.h>
#include <tether/uav/math.h>

/// Between W and the Earth (the ellipsoid of WGS 84: NGA.STND.0036, 2014). Pure.
namespace tether::sim {

struct Geodetic {
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
  double altitude_m = 0.0;  ///< above the ellipsoid
};

/// Where a point of W is on Earth: W is the plane that touches the ellipsoid at the place.
Geodetic geodetic_of(const Place& place, const uav::Vec3& p_W);
/// The inverse.
uav::Vec3 point_of(const Place& place, const Geodetic& point);

/// A vector of W along east, north and up of the place.
uav::Vec3 to_enu(const Place& place, const uav::Vec3& v_W);
/// The inverse.
uav::Vec3 from_enu(const Place& place, const uav::Vec3& v_ENU);

/// Earth's magnetic field at a place, along its east, north and up [T]: IGRF-14 at 2025.0 (Alken et
/// al., IAGA Division V, 2024), up to degree 5. Near the surface within some 1 µT.
uav::Vec3 earth_field_T(const Place& place);

/// The pressure of the standard atmosphere [Pa] at an altitude above sea level, up to 11 km
/// (ISO 2533:1975), and the altitude of a pressure [m].
double standard_pressure_pa(double altitude_m);
double standard_altitude_m(double pressure_Pa);

}  // namespace tether::sim
