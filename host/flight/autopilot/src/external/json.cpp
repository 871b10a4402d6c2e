#include "external/json.h"

#include "local_frame.h"

#include <algorithm>

#include <fmt/format.h>

namespace tether::autopilot {
namespace {

std::string list(const uav::Vec3& v) {
  return fmt::format("[{:.9g},{:.9g},{:.9g}]", v.x, v.y, v.z);
}

std::uint32_t number_at(const Bytes& bytes, std::size_t at, std::size_t size) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < size; ++i) value |= std::uint32_t{bytes[at + i]} << (8 * i);
  return value;
}

}  // namespace

std::optional<Servos> decode_servos(const Bytes& bytes) {
  constexpr std::uint32_t kMagic = 18458;
  constexpr std::size_t kStep = 4, kPwm = 8, kShort = 2;
  if (bytes.size() != kPwm + kShort * Servos::kCount || number_at(bytes, 0, kShort) != kMagic)
    return std::nullopt;
  Servos servos{.step = number_at(bytes, kStep, sizeof servos.step)};
  for (std::size_t i = 0; i < Servos::kCount; ++i)
    servos.pwm[i] = static_cast<std::uint16_t>(number_at(bytes, kPwm + kShort * i, kShort));
  return servos;
}

std::string json_state(Duration at, const sim::Place& place, const uav::BodyState& truth,
                       const Readings& readings) {
  // ArduPilot cuts each step to whole microseconds: a step must not be a little too short.
  constexpr double kLonger = 1.0 + 1e-7;
  const LocalFrame frame(place, {});
  const uav::Quat q = frame.attitude_to_ned(truth.q_WB);
  return fmt::format(
      "\n{{\"timestamp\":{:.12f},\"imu\":{{\"gyro\":{},\"accel_body\":{}}},\"position\":{},"
      "\"quaternion\":[{:.9g},{:.9g},{:.9g},{:.9g}],\"velocity\":{}}}\n",
      to_seconds(at) * kLonger, list(mavlink::frd_from_flu(readings.w_WB_B_rad_s)),
      list(mavlink::frd_from_flu(readings.specific_force_B_m_s2)), list(frame.to_ned(truth.p_WB)),
      q.w, q.x, q.y, q.z, list(frame.to_ned(truth.v_WB)));
}

double share_of_pwm(std::uint16_t pwm_us) {
  constexpr double kLeast_us = 1000.0, kMost_us = 2000.0;  // MOT_PWM_MIN, MOT_PWM_MAX
  return std::clamp((pwm_us - kLeast_us) / (kMost_us - kLeast_us), 0.0, 1.0);
}

}  // namespace tether::autopilot
