#include "errors.h"
#include "handles.h"

#include <algorithm>
#include <cstring>
#include <vector>

#include <tether/client_commands.h>
#include <tether/uav/setpoint.h>

namespace tether::c_api {

template <>
inline constexpr std::size_t kFirstSize<tether_setpoint> = 240;
template <>
inline constexpr std::size_t kFirstSize<tether_flight_limits> = 24;
template <>
inline constexpr std::size_t kFirstSize<tether_joint> = 80;

namespace {

static_assert(sizeof(tether_setpoint) >= kFirstSize<tether_setpoint>);

uav::Vec3 from_c(const tether_vec3& v) {
  return {v.x, v.y, v.z};
}

/// As many as there are; of more than are known, one more, which is refused.
template <std::size_t kKnown>
std::vector<double> numbers(const double (&values)[kKnown], std::uint32_t count) {
  std::vector<double> all(values, values + std::min<std::size_t>(count, kKnown));
  if (count > kKnown) all.resize(kKnown + 1);
  return all;
}

/// Of a caller who knows `size` bytes of the struct.
uav::TimedSetpoint from_c(const std::byte* bytes, std::size_t size) {
  tether_setpoint s{};
  std::memcpy(&s, bytes, std::min(size, sizeof s));
  // A mask or a number of rotors that no set-point has stays one.
  const auto mask = static_cast<std::uint16_t>(std::min<std::uint32_t>(s.mask, 0xFFFF));
  uav::Setpoint setpoint{.mask = mask,
                         .in_heading = s.in_heading != 0,
                         .p_WB_m = from_c(s.position_W_m),
                         .velocity_m_s = from_c(s.velocity_m_s),
                         .acceleration_m_s2 = from_c(s.acceleration_m_s2),
                         .yaw_rad = s.yaw_rad,
                         .yaw_rate_rad_s = s.yaw_rate_rad_s,
                         .q_WB = {s.q_WB.w, s.q_WB.x, s.q_WB.y, s.q_WB.z},
                         .w_WB_B_rad_s = from_c(s.rates_B_rad_s),
                         .thrust_N = s.thrust_N,
                         .rotor_speeds_rad_s = numbers(s.rotor_speeds_rad_s, s.rotors),
                         .joints_rad = numbers(s.joints_rad, s.joints)};
  return {Duration(s.after_ns), std::move(setpoint)};
}

}  // namespace
}  // namespace tether::c_api

using namespace tether::c_api;

extern "C" {

tether_status tether_get_flight_limits(const tether_vehicle* vehicle, tether_flight_limits* out,
                                       size_t size) noexcept {
  if (!can_take(out, size) || !are_given(vehicle)) return TETHER_INVALID;
  const auto& limits = vehicle->vehicle->catalogue().limits;
  put(tether_flight_limits{limits.max_rotor_speed_rad_s, limits.max_thrust_N, limits.rotors, 0},
      out, size);
  return TETHER_OK;
}

size_t tether_joint_count(const tether_vehicle* vehicle) noexcept {
  return are_given(vehicle) ? vehicle->vehicle->catalogue().limits.joints.size() : 0;
}

tether_status tether_get_joint(const tether_vehicle* vehicle, size_t index, tether_joint* out,
                               size_t size) noexcept {
  if (!can_take(out, size) || !are_given(vehicle)) return TETHER_INVALID;
  if (index >= tether_joint_count(vehicle)) return fail(TETHER_INVALID, "there is no such joint");
  const auto& joint = vehicle->vehicle->catalogue().limits.joints[index];
  const auto& [x, y, z] = joint.p_BJ;
  put(tether_joint{joint.name.c_str(),
                   {x, y, z},
                   {joint.axis_B.x, joint.axis_B.y, joint.axis_B.z},
                   joint.min_rad,
                   joint.max_rad,
                   joint.max_rate_rad_s},
      out, size);
  return TETHER_OK;
}

tether_status tether_follow(tether_vehicle* vehicle, const tether_setpoint* setpoints, size_t count,
                            size_t size) noexcept {
  if (!are_given(vehicle, setpoints)) return TETHER_INVALID;
  return guarded([&] {
    if (size < kFirstSize<tether_setpoint>)
      return fail(TETHER_INVALID, "`size` must be the size of tether_setpoint");
    std::vector<tether::uav::TimedSetpoint> trajectory;
    // Of a list that is too long, one more than is allowed: enough to be refused.
    const auto* bytes = reinterpret_cast<const std::byte*>(setpoints);
    for (size_t i = 0; i < std::min(count, tether::uav::kMaxTrajectorySetpoints + 1); ++i)
      trajectory.push_back(from_c(bytes + i * size, size));
    return status_of(vehicle->vehicle->follow(trajectory));
  });
}

}  // extern "C"
