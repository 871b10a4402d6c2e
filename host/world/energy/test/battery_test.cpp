#include "known_energy.h"
#include "test_model.h"

#include <cmath>

#include <gtest/gtest.h>

#include <tether/energy/meter.h>

namespace tether::energy {
namespace {

const Battery kBattery = hummingbird_model().battery;

TEST(Battery, VoltageIsLinearBetweenPoints) {
  EXPECT_DOUBLE_EQ(open_circuit_voltage_V(kBattery, 0.0), 9.9);
  EXPECT_DOUBLE_EQ(open_circuit_voltage_V(kBattery, 0.05), 10.35);
  EXPECT_DOUBLE_EQ(open_circuit_voltage_V(kBattery, 1.0), 12.6);
}

TEST(Battery, StoredEnergyIsTheIntegralOfTheVoltage) {
  EXPECT_DOUBLE_EQ(stored_energy_J(kBattery, 0.0), 0.0);
  EXPECT_NEAR(stored_energy_J(kBattery, 1.0), 7560.0 * (0.1 * 10.35 + 0.9 * 11.7), 1e-6);
  EXPECT_NEAR(stored_energy_J(kBattery, 0.05), 7560.0 * 0.05 * 10.125, 1e-6);
}

TEST(Battery, SagsUnderLoad) {
  const Discharge given = discharge(kBattery, 1.0, 120.0);
  EXPECT_NEAR(given.voltage_V * given.current_A, 120.0, 1e-9);
  EXPECT_NEAR(given.voltage_V, 12.6 - 0.05 * given.current_A, 1e-12);
  EXPECT_NEAR(given.heat_W, 0.05 * given.current_A * given.current_A, 1e-12);
  EXPECT_FALSE(given.is_exhausted);
}

TEST(Battery, WithoutResistanceKeepsItsVoltage) {
  Battery ideal = kBattery;
  ideal.resistance_ohm = 0.0;
  EXPECT_DOUBLE_EQ(discharge(ideal, 1.0, 126.0).current_A, 10.0);
}

TEST(Battery, IsExhaustedByChargeCutOffOrPower) {
  EXPECT_TRUE(discharge(kBattery, 0.0, 1.0).is_exhausted);
  EXPECT_EQ(discharge(kBattery, 0.0, 1.0).current_A, 0.0);
  EXPECT_TRUE(discharge(kBattery, 0.01, 300.0).is_exhausted);  // 8.2 V
  const Discharge most = discharge(kBattery, 1.0, 1e4);
  EXPECT_TRUE(most.is_exhausted);
  EXPECT_NEAR(most.power_W, 12.6 * 12.6 / 0.2, 1e-9);
}

}  // namespace
}  // namespace tether::energy
