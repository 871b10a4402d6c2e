#include "mixer.h"

#include <algorithm>
#include <cmath>

namespace tether::uav {
namespace {

using Vec4 = std::array<double, 4>;  // thrust, roll, pitch, yaw
using Mat4 = std::array<Vec4, 4>;

/// Effect of one newton of a rotor's thrust: a column of the allocation matrix A. The torque of its
/// thrust is p × z; its reaction torque opposes the spin.
Vec4 effect_of(const MultirotorParameters& parameters, const Rotor& rotor) {
  return {1.0, rotor.p_BR.y, -rotor.p_BR.x, -rotor.direction * parameters.moment_coefficient_m};
}

/// Lower triangle of the Cholesky factor of A·Aᵀ.
Mat4 factorized_gram(const std::array<Vec4, MultirotorState::kMaxRotors>& columns,
                     std::size_t count) {
  Mat4 l{};
  for (std::size_t r = 0; r < 4; ++r) {
    for (std::size_t c = 0; c <= r; ++c) {
      double sum = 0.0;
      for (std::size_t i = 0; i < count; ++i) {
        sum += columns[i][r] * columns[i][c];
      }
      for (std::size_t k = 0; k < c; ++k) {
        sum -= l[r][k] * l[c][k];
      }
      l[r][c] = r == c ? std::sqrt(sum) : sum / l[c][c];
    }
  }
  return l;
}

/// x with (L·Lᵀ) x = b.
Vec4 solve(const Mat4& l, Vec4 b) {
  for (std::size_t r = 0; r < 4; ++r) {
    for (std::size_t c = 0; c < r; ++c) {
      b[r] -= l[r][c] * b[c];
    }
    b[r] /= l[r][r];
  }
  for (std::size_t r = 4; r-- > 0;) {
    for (std::size_t c = r + 1; c < 4; ++c) {
      b[r] -= l[c][r] * b[c];
    }
    b[r] /= l[r][r];
  }
  return b;
}

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

RotorThrusts mix(const MultirotorParameters& parameters, const Demand& demand) {
  const std::size_t count = std::min(parameters.rotors.size(), MultirotorState::kMaxRotors);
  std::array<Vec4, MultirotorState::kMaxRotors> columns{};
  for (std::size_t i = 0; i < count; ++i) {
    columns[i] = effect_of(parameters, parameters.rotors[i]);
  }
  const Mat4 gram = factorized_gram(columns, count);
  const auto thrusts_for = [&](const Vec4& wanted) {
    const Vec4 x = solve(gram, wanted);
    RotorThrusts thrusts{};
    for (std::size_t i = 0; i < count; ++i) {
      const Vec4& a = columns[i];
      thrusts[i] = a[0] * x[0] + a[1] * x[1] + a[2] * x[2] + a[3] * x[3];
    }
    return thrusts;
  };

  // In the order of their priority.
  const double limit = max_rotor_thrust_N(parameters);
  const Vec3& torque = demand.torque_B_N_m;
  RotorThrusts thrusts{};
  add_within(limit, count, thrusts_for({demand.thrust_N, 0.0, 0.0, 0.0}), thrusts);
  add_within(limit, count, thrusts_for({0.0, torque.x, torque.y, 0.0}), thrusts);
  add_within(limit, count, thrusts_for({0.0, 0.0, 0.0, torque.z}), thrusts);
  return thrusts;
}

}  // namespace tether::uav
