#include "external/hil.h"

#include <numbers>

#include <gtest/gtest.h>

namespace tether::autopilot {
namespace {

using std::chrono::milliseconds;

const sim::Place kPlace{};
const uav::Vec3 kField_T{6e-6, 2.3e-5, -4.2e-5};

// Looking east (the yaw 0 of ENU), at rest.
TEST(Hil, SensorsOfAVehicleAtRestAreInFrdAndInTheirUnits) {
  const Readings readings = ideal_readings({}, {0.0, 0.0, 9.81}, kPlace, kField_T);
  const mavlink::Message m = hil_sensor(milliseconds(12), readings);
  EXPECT_EQ(m.integer("time_usec"), 12'000);
  EXPECT_NEAR(m.number("zacc"), -9.81, 1e-5);
  EXPECT_NEAR(m.number("xmag"), 0.06, 1e-6) << "ahead is east";
  EXPECT_NEAR(m.number("ymag"), -0.23, 1e-6) << "right is south";
  EXPECT_NEAR(m.number("zmag"), 0.42, 1e-6) << "down";
  EXPECT_NEAR(m.number("abs_pressure"), 956.0, 2.0) << "488 m above the sea";
  EXPECT_NEAR(m.number("pressure_alt"), 488.0, 0.1);
  EXPECT_EQ(m.integer("fields_updated"), 0x1FFF & ~0x400);
}

TEST(Hil, ABodyThatTurnsToTheLeftHasANegativeYawRate) {
  const Readings readings = ideal_readings({{}, {}, {}, {0.0, 0.0, 0.5}}, {}, kPlace, kField_T);
  EXPECT_NEAR(hil_sensor({}, readings).number("zgyro"), -0.5, 1e-6);
}

TEST(Hil, PositionsAreInTheUnitsOfGps) {
  const Readings readings =
      ideal_readings({{0.0, 0.0, 10.0}, {}, {3.0, 0.0, 1.0}, {}}, {}, kPlace, kField_T);
  const mavlink::Message m = hil_gps(milliseconds(200), readings.position);
  EXPECT_EQ(m.integer("time_usec"), 1'767'225'600'200'000);
  EXPECT_NEAR(m.number("lat"), 473'979'710, 2);
  EXPECT_NEAR(m.number("lon"), 85'461'640, 2);
  EXPECT_EQ(m.integer("alt"), 498'000);
  EXPECT_EQ(m.integer("ve"), 300);
  EXPECT_EQ(m.integer("vd"), -100);
  EXPECT_EQ(m.integer("cog"), 9'000) << "east";
  EXPECT_EQ(m.integer("fix_type"), 3);
  uav::NavSatSample lost;
  EXPECT_EQ(hil_gps({}, lost).integer("fix_type"), 1);
  EXPECT_EQ(hil_gps({}, lost).integer("eph"), 65'535);
}

TEST(Hil, RotorsHaveSharesFromZeroToOne) {
  mavlink::Message m("HIL_ACTUATOR_CONTROLS");
  m.set("controls", 0.5, 0).set("controls", 2.0, 1).set("controls", -1.0, 2);
  m.set("controls", std::numeric_limits<double>::quiet_NaN(), 3);
  EXPECT_EQ(rotor_shares(m, 4), (std::vector<double>{0.5, 1.0, 0.0, 0.0}));
}

}  // namespace
}  // namespace tether::autopilot
