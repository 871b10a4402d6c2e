#include <cmath>

#include <tether/uav/samples.h>

namespace tether::uav {
namespace {

constexpr double kMaxSpeed_m_s = 100.0;
constexpr double kMaxRate_rad_s = 100.0;

/// False for NaN, too.
bool is_within(double value, double limit) {
  return std::abs(value) <= limit;
}

}  // namespace

SimTime sampled_at(const Sample& sample) {
  return std::visit([](const auto& s) { return s.sampled_at; }, sample);
}

bool is_valid(const VelocityCommand& command) {
  const Vec3& v = command.velocity_H_m_s;
  return is_within(v.x, kMaxSpeed_m_s) && is_within(v.y, kMaxSpeed_m_s) &&
         is_within(v.z, kMaxSpeed_m_s) && is_within(command.yaw_rate_rad_s, kMaxRate_rad_s);
}

}  // namespace tether::uav
