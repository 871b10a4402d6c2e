#pragma once

#include <cstdint>

#include <tether/autopilot/external.h>
#include <tether/autopilot/flight_controller.h>
#include <tether/sim/world.h>
#include <tether/uav/multirotor.h>
#include <tether/uav/samples.h>

/// What the sensors on board of a vehicle show to its flight controller. Pure functions; all
/// vectors in the body frame are FLU, in the world ENU.
namespace tether::autopilot {

/// At one instant.
struct Readings {
  uav::Vec3 specific_force_B_m_s2;
  uav::Vec3 w_WB_B_rad_s;
  uav::Vec3 field_B_T;
  double pressure_Pa = 0.0;
  uav::NavSatSample position{};
};

/// Of a vehicle without errors. `specific_force_B_m_s2` is that of the argument.
Readings ideal_readings(const uav::BodyState& truth, const uav::Vec3& specific_force_B_m_s2,
                        const sim::Place& place, const uav::Vec3& magnetic_field_W_T);

/// Of the vehicle's sensors; ideal ones of what it lacks. @pre it has an IMU
Readings readings_of(const ExternalSettings& settings, const Sensed& sensed);

/// A little noise, as any device has: keyed by the seed and the step.
Readings with_noise(Readings readings, std::uint64_t seed, std::uint64_t step);

/// nullptr: the vehicle has none.
const sim::Sensor* sensor_of(const sim::Uav& vehicle, uav::SensorKind kind);

}  // namespace tether::autopilot
