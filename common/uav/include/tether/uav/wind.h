#pragma once

#include <cstdint>
#include <string_view>

#include <tether/base/time.h>
#include <tether/uav/math.h>

/// The wind at a UAV: a mean that may grow with height, and turbulence (MIL-F-8785C, "Flying
/// qualities of piloted airplanes", 1980, sections 3.7.2 and 3.7.3: Dryden's form at low altitude).
namespace tether::uav {

struct Wind {
  Vec3 v_WA_m_s;  ///< velocity of the air, 6.1 m above W's origin if it grows with height
  double roughness_m = 0.0;  ///< of the ground, at which the horizontal wind is 0; 0: as everywhere
  double turbulence = 0.0;   ///< factor on the standard deviations of the gusts; 0: none
  friend bool operator==(const Wind&, const Wind&) = default;

  bool is_calm() const { return v_WA_m_s == Vec3{}; }
  bool gusts() const { return turbulence > 0.0 && !is_calm(); }
};

/// At which height a wind that grows with height is given.
inline constexpr double kWindHeight_m = 6.096;

/// The mean wind at that height above W's origin: logarithmic between `roughness_m` and above.
/// @pre roughness_m < kWindHeight_m
Vec3 mean_wind_W(const Wind& wind, double height_m);

/// How fast the wind may be anywhere up to 305 m: gusts of more than six standard deviations do not
/// count.
double most_wind_m_s(const Wind& wind);

/// Standard deviations and lengths of the gusts along, across and upwards: Dryden's, of a mean wind
/// 6.1 m above the ground. Heights are brought into 3 m to 305 m, for which the standard is made.
struct Turbulence {
  Vec3 sigma_m_s;
  Vec3 length_m;
};
Turbulence turbulence_at(const Wind& wind, double height_m);

/// The gusts that one UAV meets, step by step: white noise behind Dryden's filters, whose air
/// passes the UAV at its airspeed. A value; allocates nothing.
class Gusts {
 public:
  /// Of another seed or UAV, all numbers are others.
  Gusts(const Wind& wind, Duration step, std::uint64_t seed, std::string_view uav);

  /// The wind of the next step, at a UAV at this height that moves so. Call once a step.
  Vec3 step(double height_m, const Vec3& v_WB);

 private:
  struct Filter {
    double first = 0.0, second = 0.0;
  };

  Wind wind_;
  double dt_s_;
  std::uint64_t seed_, stream_, steps_ = 0;
  Filter along_, across_, up_;  // each of variance 1 and 1/2
  Turbulence turbulence_;       // at this height
  double turbulence_at_ft_ = 0.0;
};

}  // namespace tether::uav
