#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <tether/sim/geodesy.h>

namespace tether::sim {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr double kMetresPerDegree = 111'320.0;  // of longitude, at the equator

TEST(Geodesy, TheOriginIsThePlace) {
  for (const double latitude_deg : {-90.0, -45.0, 0.0, 12.5, 89.0, 90.0}) {
    const Place place{latitude_deg, 123.25, 250.0, 0.7};
    const Geodetic got = geodetic_of(place, {});
    EXPECT_NEAR(got.latitude_deg, latitude_deg, 1e-11);
    const bool is_pole = std::abs(latitude_deg) == 90.0;
    EXPECT_NEAR(is_pole ? 123.25 : got.longitude_deg, 123.25, 1e-11);
    EXPECT_NEAR(got.altitude_m, 250.0, 1e-7);
  }
}

// One degree is 2π·6378137/360 m of longitude at the equator, and 111,131.75 m of latitude at 45°
// (meridian radius of WGS 84 at 45°: 6,367,381.8 m).
TEST(Geodesy, DegreesHaveTheirLength) {
  const Geodetic east = geodetic_of({0.0, 0.0, 0.0, 0.0}, {100.0, 0.0, 0.0});
  EXPECT_NEAR(east.longitude_deg, 100.0 * 360.0 / (2.0 * std::numbers::pi * 6378137.0), 1e-12);
  const Geodetic north = geodetic_of({45.0, 0.0, 0.0, 0.0}, {0.0, 100.0, 0.0});
  EXPECT_NEAR(north.latitude_deg - 45.0, 100.0 / (6367381.8 * std::numbers::pi / 180.0), 1e-9);
  EXPECT_NEAR(geodetic_of({45.0, 0.0, 5.0, 0.0}, {0.0, 0.0, 2.5}).altitude_m, 7.5, 1e-8);
}

// W touches the ellipsoid at the place: the surface falls away by d²/2R.
TEST(Geodesy, ThePlaneIsFlatAndTheEarthIsRound) {
  const double d_m = 10'000.0;
  EXPECT_NEAR(geodetic_of({0.0, 0.0, 0.0, 0.0}, {d_m, 0.0, 0.0}).altitude_m,
              d_m * d_m / (2.0 * 6378137.0), 1e-4);
}

TEST(Geodesy, AHeadingTurnsWClockwise) {
  const Place place{0.0, 0.0, 0.0, 0.5 * std::numbers::pi};
  const uav::Vec3 enu = to_enu(place, {0.0, 1.0, 3.0});
  EXPECT_NEAR(enu.x, 1.0, 1e-12) << "W's y points east";
  EXPECT_NEAR(enu.y, 0.0, 1e-12);
  EXPECT_EQ(enu.z, 3.0);
  EXPECT_NEAR(geodetic_of(place, {0.0, kMetresPerDegree, 0.0}).longitude_deg, 1.0, 1e-3);
}

// ISO 2533, table 1: pressures at 0, 1000, 5000 and 11,000 m (geopotential altitudes).
TEST(StandardAtmosphere, HasThePressuresOfTheStandard) {
  for (const auto& [altitude_m, pressure_Pa] :
       {std::pair{0.0, 101325.0}, {1000.0, 89874.6}, {5000.0, 54019.9}, {11000.0, 22632.0}}) {
    EXPECT_NEAR(standard_pressure_pa(altitude_m), pressure_Pa, 1.0) << altitude_m;
    EXPECT_NEAR(standard_altitude_m(standard_pressure_pa(altitude_m)), altitude_m, 1e-6);
  }
  EXPECT_TRUE(std::isfinite(standard_pressure_pa(1e6)));
  EXPECT_TRUE(std::isfinite(standard_altitude_m(-1.0)));
}

TEST(Geodesy, APointComesBackFromItsPlaceOnEarth) {
  const Place place{47.4, 8.5, 488.0, 0.3};
  for (const uav::Vec3& p_W :
       {uav::Vec3{}, uav::Vec3{120.0, -30.0, 4.0}, uav::Vec3{-5000.0, 8000.0, 900.0}}) {
    const uav::Vec3 back = point_of(place, geodetic_of(place, p_W));
    EXPECT_LT(norm(back - p_W), 1e-6);
    EXPECT_LT(norm(from_enu(place, to_enu(place, p_W)) - p_W), 1e-9);
  }
}

// Declination and inclination [deg] and strength [T] by the whole model, of degree 13, in 2025.
TEST(Geodesy, TheMagneticFieldIsThatOfThePlace) {
  struct Case {
    double latitude_deg, longitude_deg, declination_deg, inclination_deg, strength_T;
  };
  for (const Case& at :
       {Case{47.4, 8.5, 3.4, 63.6, 48.5e-6}, Case{40.0, -105.3, 7.8, 65.7, 51.4e-6},
        Case{-33.9, 151.2, 12.8, -64.3, 57.0e-6}}) {
    const uav::Vec3 field_T = earth_field_T({at.latitude_deg, at.longitude_deg, 0.0, 0.0});
    const double across_T = std::hypot(field_T.x, field_T.y);
    EXPECT_NEAR(std::atan2(field_T.x, field_T.y) * kDegrees, at.declination_deg, 2.0);
    EXPECT_NEAR(std::atan2(-field_T.z, across_T) * kDegrees, at.inclination_deg, 1.5);
    EXPECT_NEAR(norm(field_T), at.strength_T, 1e-6);
  }
  const uav::Vec3 at_pole_T = earth_field_T({90.0, 0.0, 0.0, 0.0});
  EXPECT_LT(norm(at_pole_T - earth_field_T({90.0 - 1e-7, 0.0, 0.0, 0.0})), 1e-12);
}

}  // namespace
}  // namespace tether::sim
