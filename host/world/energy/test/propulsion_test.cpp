#include "known_energy.h"
#include "test_model.h"

#include <cmath>

#include <gtest/gtest.h>

#include <tether/energy/meter.h>

namespace tether::energy {
namespace {

const Propulsion kPropulsion = hummingbird_model().propulsion;

double hover_speed_rad_s() {
  return std::sqrt(kAirframe.mass_kg * kGravity_m_s2 / 4.0 / kAirframe.thrust_coefficient);
}

TEST(Propulsion, HoverTakesThePowerOfTheReactionTorque) {
  const double speed = hover_speed_rad_s();
  const double thrust = kAirframe.mass_kg * kGravity_m_s2 / 4.0;
  const RotorPower power = rotor_power(kAirframe, kPropulsion, speed, {});
  EXPECT_NEAR(power.total_w(), kAirframe.moment_coefficient_m * thrust * speed, 1e-9);
  // Ideal power of a disc: T^1.5 / sqrt(2 rho A).
  EXPECT_NEAR(power.induced_W, 1.15 * std::pow(thrust, 1.5) / std::sqrt(2.0 * 1.225 * M_PI * 0.01),
              1e-9);
  EXPECT_GT(power.profile_W, 0.0);
}

// Leishman, section 2.13.1: in axial climb, v = −V/2 + √((V/2)² + v_h²).
TEST(Propulsion, ClimbFollowsTheClosedSolution) {
  const double speed = hover_speed_rad_s();
  const double thrust = kAirframe.mass_kg * kGravity_m_s2 / 4.0;
  const double hover_m_s = std::sqrt(thrust / (2.0 * 1.225 * M_PI * 0.01));
  for (const double climb : {0.1, 2.0, 20.0}) {
    const RotorPower power = rotor_power(kAirframe, kPropulsion, speed, {0, 0, climb});
    const double induced = -climb / 2.0 + std::sqrt(climb * climb / 4.0 + hover_m_s * hover_m_s);
    EXPECT_NEAR(power.induced_W, 1.15 * thrust * induced, 1e-6) << climb;
    EXPECT_NEAR(power.parasitic_W, thrust * climb, 1e-9) << climb;
  }
}

// Glauert's limit far above the hover's inflow: v = v_h² / V.
TEST(Propulsion, FastFlightNeedsLittleInducedPower) {
  const double speed = hover_speed_rad_s();
  const double thrust = kAirframe.mass_kg * kGravity_m_s2 / 4.0;
  const double hover_m_s = std::sqrt(thrust / (2.0 * 1.225 * M_PI * 0.01));
  const RotorPower power = rotor_power(kAirframe, kPropulsion, speed, {100, 0, 0});
  EXPECT_NEAR(power.induced_W, 1.15 * thrust * hover_m_s * hover_m_s / 100.0, 1e-4);
}

TEST(Propulsion, RotorAtRestTakesNothing) {
  EXPECT_EQ(rotor_power(kAirframe, kPropulsion, 0.0, {3, 1, -2}).total_w(), 0.0);
}

// docs/guide/energy.md states these figures.
TEST(Propulsion, HummingbirdHoversAndFliesAsDocumented) {
  EXPECT_NEAR(level_flight_power_W(kAirframe, kPropulsion, kGravity_m_s2, 0.0), 72.8, 0.05);
  uav::MultirotorParameters unlimited = kAirframe;
  unlimited.max_horizontal_speed_m_s = 30.0;
  const double best = best_range_speed_m_s(unlimited, kPropulsion, kGravity_m_s2, 0.0);
  EXPECT_NEAR(best, 14.2, 0.1);
  EXPECT_NEAR(level_flight_power_W(kAirframe, kPropulsion, kGravity_m_s2, 5.0), 65.4, 0.05);
}

}  // namespace
}  // namespace tether::energy
