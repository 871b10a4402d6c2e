#include <algorithm>
#include <cmath>
#include <numbers>

#include <tether/base/random.h>
#include <tether/uav/wind.h>

// The longitudinal filter is σ √(2 L / π V) / (1 + L s / V); the others are
// σ √(L / π V) (1 + √3 L s / V) / (1 + L s / V)². With p = V / L, both follow from two states:
//   x₁' = −p x₁ + √(2p) n,   x₂' = p (x₁ − x₂),
// n white: Var x₁ = 1, Var x₂ = E[x₁x₂] = 1/2. Along the wind the gust is σ x₁; across and upwards
// σ (√3 x₁ + (1 − √3) x₂) / √2, whose variance is σ².
namespace tether::uav {
namespace {

constexpr double kFoot_m = 0.3048;
/// Air that stands still would bring the same gust for ever.
constexpr double kLeastAirspeed_m_s = 0.5;

double log_profile(double height_m, double roughness_m) {
  if (height_m <= roughness_m) return 0.0;
  return std::log(height_m / roughness_m) / std::log(kWindHeight_m / roughness_m);
}

/// Brought into the heights for which the standard is made.
double dryden_height_ft(double height_m) {
  constexpr double kLeast_ft = 10.0, kMost_ft = 1000.0;
  return std::clamp(height_m / kFoot_m, kLeast_ft, kMost_ft);
}

}  // namespace

Vec3 mean_wind_W(const Wind& wind, double height_m) {
  if (wind.roughness_m <= 0.0) return wind.v_WA_m_s;
  const double share = log_profile(height_m, wind.roughness_m);
  return {share * wind.v_WA_m_s.x, share * wind.v_WA_m_s.y, wind.v_WA_m_s.z};
}

Turbulence turbulence_at(const Wind& wind, double height_m) {
  const double h_ft = dryden_height_ft(height_m);
  const double base = 0.177 + 0.000823 * h_ft;
  const double up_m_s = 0.1 * std::hypot(wind.v_WA_m_s.x, wind.v_WA_m_s.y) * wind.turbulence;
  const double level_m_s = up_m_s / std::pow(base, 0.4);
  const double level_m = kFoot_m * h_ft / std::pow(base, 1.2);
  return {{level_m_s, level_m_s, up_m_s}, {level_m, level_m, kFoot_m * h_ft}};
}

double most_wind_m_s(const Wind& wind) {
  constexpr double kMostHeight_m = 305.0, kSigmas = 6.0;
  const auto gust_m_s = [&](double height_m) {
    return norm(turbulence_at(wind, height_m).sigma_m_s);
  };
  return norm(mean_wind_W(wind, kMostHeight_m)) +
         kSigmas * std::max(gust_m_s(0.0), gust_m_s(kMostHeight_m));
}

Gusts::Gusts(const Wind& wind, Duration step, std::uint64_t seed, std::string_view uav)
    : wind_(wind), dt_s_(to_seconds(step)), seed_(seed), stream_(random_stream(uav, "", "gusts")) {
  // As if it had blown for long.
  KeyedRandom random({seed_, stream_, steps_++});
  for (Filter* filter : {&along_, &across_, &up_}) {
    filter->first = random.normal();
    filter->second = 0.5 * (filter->first + random.normal());
  }
}

Vec3 Gusts::step(double height_m, const Vec3& v_WB) {
  const Vec3 mean = mean_wind_W(wind_, height_m);
  if (!wind_.gusts()) return mean;
  // Near the ground it stays the same.
  if (const double at_ft = dryden_height_ft(height_m); at_ft != turbulence_at_ft_) {
    turbulence_at_ft_ = at_ft;
    turbulence_ = turbulence_at(wind_, height_m);
  }
  const double airspeed_m_s = std::max(norm(v_WB - mean), kLeastAirspeed_m_s);
  KeyedRandom random({seed_, stream_, steps_++});
  const auto advance = [&](Filter& filter, double length_m) {
    const double kept = std::exp(-airspeed_m_s / length_m * dt_s_);
    filter.second += (1.0 - kept) * (filter.first - filter.second);
    filter.first = kept * filter.first + std::sqrt(1.0 - kept * kept) * random.normal();
  };
  advance(along_, turbulence_.length_m.x);
  advance(across_, turbulence_.length_m.y);
  advance(up_, turbulence_.length_m.z);
  constexpr double kRoot3 = std::numbers::sqrt3, kRoot2 = std::numbers::sqrt2;
  const auto second_order = [](const Filter& filter) {
    return (kRoot3 * filter.first + (1.0 - kRoot3) * filter.second) / kRoot2;
  };
  const double speed_m_s = std::hypot(wind_.v_WA_m_s.x, wind_.v_WA_m_s.y);
  // A wind that only rises has no direction along the ground, and no gusts.
  const Vec3 ahead = speed_m_s > 0.0
                         ? (1.0 / speed_m_s) * Vec3{wind_.v_WA_m_s.x, wind_.v_WA_m_s.y, 0.0}
                         : Vec3{1.0, 0.0, 0.0};
  const double along = turbulence_.sigma_m_s.x * along_.first;
  const double across = turbulence_.sigma_m_s.y * second_order(across_);
  return mean + Vec3{along * ahead.x - across * ahead.y, along * ahead.y + across * ahead.x,
                     turbulence_.sigma_m_s.z * second_order(up_)};
}

}  // namespace tether::uav
