#pragma once

#include <cstdint>
#include <vector>

#include <tether/base/time.h>
#include <tether/mavlink/message.h>
#include <tether/sim/world.h>
#include <tether/uav/multirotor.h>
#include <tether/uav/samples.h>

/// What a simulation in the loop tells a flight controller, as messages of MAVLink (mavlink.io,
/// "HIL_SENSOR", "HIL_GPS", "HIL_ACTUATOR_CONTROLS"). Pure functions; all vectors in the body frame
/// are FLU, in the world ENU.
namespace tether::autopilot {

/// What the sensors on board show at one instant.
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

/// A little noise, as any device has: keyed by the seed and the step.
Readings with_noise(Readings readings, std::uint64_t seed, std::uint64_t step);

/// `at` is the controller's own clock.
mavlink::Message hil_sensor(Duration at, const Readings& readings);
mavlink::Message hil_gps(Duration at, const uav::NavSatSample& position);

/// The speeds of the rotors, of which the controller sets shares.
std::vector<double> rotor_speeds_rad_s(const mavlink::Message& controls, std::size_t rotors,
                                       double max_rad_s);

}  // namespace tether::autopilot
