#include "external/readings.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace tether::autopilot {
namespace {

TEST(Readings, AreThoseOfTheVehiclesSensorsAndIdealOnesOfWhatItLacks) {
  ExternalSettings settings;
  settings.magnetic_field_T = {1e-5, 2e-5, 0.0};
  // The IMU looks to the left.
  sim::Sensor imu;
  imu.name = "imu";
  imu.model = sim::ImuModel{};
  imu.X_BS.q = uav::from_axis_angle({0.0, 0.0, 1.0}, std::numbers::pi / 2.0);
  settings.vehicle.sensors = {imu};
  Sensed sensed;
  sensed.measure = [](uav::SensorKind kind) -> std::optional<uav::Sample> {
    if (kind != uav::SensorKind::kImu) return std::nullopt;
    uav::ImuSample sample;
    sample.specific_force_m_s2 = {1.0, 0.0, 9.8};
    sample.angular_velocity_rad_s = {0.0, 0.5, 0.0};
    return sample;
  };
  const Readings readings = readings_of(settings, sensed);
  EXPECT_NEAR(readings.specific_force_B_m_s2.x, 0.0, 1e-12);
  EXPECT_NEAR(readings.specific_force_B_m_s2.y, 1.0, 1e-12);
  EXPECT_NEAR(readings.w_WB_B_rad_s.x, -0.5, 1e-12);
  EXPECT_EQ(readings.field_B_T.y, 2e-5);
  EXPECT_NEAR(readings.position.altitude_m, 488.0, 1e-6);
}

TEST(Readings, NoiseIsKeyedAndSmall) {
  const Readings exact = ideal_readings({}, {0.0, 0.0, 9.81}, {}, {6e-6, 2.3e-5, -4.2e-5});
  double sum = 0.0, squares = 0.0;
  constexpr int kSteps = 2'000;
  for (std::uint64_t step = 0; step < kSteps; ++step) {
    const double error =
        with_noise(exact, 1, step).specific_force_B_m_s2.z - exact.specific_force_B_m_s2.z;
    sum += error;
    squares += error * error;
  }
  EXPECT_NEAR(sum / kSteps, 0.0, 0.003);
  EXPECT_NEAR(std::sqrt(squares / kSteps), 0.03, 0.002);
  EXPECT_EQ(with_noise(exact, 1, 7).pressure_Pa, with_noise(exact, 1, 7).pressure_Pa);
  EXPECT_NE(with_noise(exact, 1, 7).pressure_Pa, with_noise(exact, 2, 7).pressure_Pa);
}

}  // namespace
}  // namespace tether::autopilot
