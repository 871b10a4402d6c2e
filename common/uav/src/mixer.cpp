#include <algorithm>
#include <cmath>

#include <tether/uav/multirotor.h>

namespace tether::uav {
namespace {

/// Adds as much of `extra` to `thrusts` as keeps each in [0, limit]: the direction is kept, the
/// length scaled.
void add_within(double limit, std::size_t count, const RotorThrusts& extra, RotorThrusts& thrusts) {
  double scale = 1.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double room = extra[i] > 0.0 ? limit - thrusts[i] : -thrusts[i];
    if (extra[i] * scale > room && extra[i] > 0.0) {
      scale = room / extra[i];
    } else if (extra[i] * scale < room && extra[i] < 0.0) {
      scale = room / extra[i];
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    thrusts[i] = std::clamp(thrusts[i] + scale * extra[i], 0.0, limit);
  }
}

}  // namespace

double max_rotor_thrust_N(const MultirotorParameters& parameters) {
  const double speed = parameters.max_rotor_speed_rad_s;
  return parameters.thrust_coefficient * speed * speed;
}

FlightLimits flight_limits(const MultirotorParameters& parameters) {
  return {static_cast<std::uint32_t>(parameters.rotors.size()), parameters.max_rotor_speed_rad_s,
          static_cast<double>(parameters.rotors.size()) * max_rotor_thrust_N(parameters)};
}

// The torque of a rotor's thrust is p × z; its reaction torque opposes the spin.
Mixer::Mixer(const MultirotorParameters& parameters)
    : count_(std::min(parameters.rotors.size(), MultirotorState::kMaxRotors)) {
  for (std::size_t i = 0; i < count_; ++i) {
    const auto& [p_BR, direction] = parameters.rotors[i];
    effects_[i] = {1.0, p_BR.y, -p_BR.x, -direction * parameters.moment_coefficient_m};
  }
  for (std::size_t r = 0; r < 4; ++r) {
    for (std::size_t c = 0; c <= r; ++c) {
      double sum = 0.0;
      for (std::size_t i = 0; i < count_; ++i) sum += effects_[i][r] * effects_[i][c];
      for (std::size_t k = 0; k < c; ++k) sum -= gram_[r][k] * gram_[c][k];
      gram_[r][c] = r == c ? std::sqrt(sum) : sum / gram_[c][c];
    }
  }
}

// Aᵀ·x with (L·Lᵀ) x = wanted. The demands advance side by side: most of the time, each division
// waits for the one before.
std::array<RotorThrusts, 3> Mixer::thrusts_for(const std::array<Vec4, 3>& wanted) const {
  std::array<Vec4, 3> solved = wanted;
  for (std::size_t r = 0; r < 4; ++r) {
    for (Vec4& x : solved) {
      for (std::size_t c = 0; c < r; ++c) x[r] -= gram_[r][c] * x[c];
      x[r] /= gram_[r][r];
    }
  }
  for (std::size_t r = 4; r-- > 0;) {
    for (Vec4& x : solved) {
      for (std::size_t c = r + 1; c < 4; ++c) x[r] -= gram_[c][r] * x[c];
      x[r] /= gram_[r][r];
    }
  }
  std::array<RotorThrusts, 3> thrusts{};
  for (std::size_t i = 0; i < count_; ++i) {
    const Vec4& a = effects_[i];
    for (std::size_t demand = 0; demand < 3; ++demand) {
      const Vec4& x = solved[demand];
      thrusts[demand][i] = a[0] * x[0] + a[1] * x[1] + a[2] * x[2] + a[3] * x[3];
    }
  }
  return thrusts;
}

// In the order of their priority.
RotorThrusts Mixer::mix(const Demand& demand, double limit_N) const {
  const Vec3& torque = demand.torque_B_N_m;
  RotorThrusts thrusts{};
  for (const RotorThrusts& extra : thrusts_for({{{demand.thrust_N, 0.0, 0.0, 0.0},
                                                 {0.0, torque.x, torque.y, 0.0},
                                                 {0.0, 0.0, 0.0, torque.z}}}))
    add_within(limit_N, count_, extra, thrusts);
  return thrusts;
}

}  // namespace tether::uav
