#include "external/hil.h"

#include <algorithm>
#include <cmath>

#include <tether/base/random.h>
#include <tether/base/units.h>
#include <tether/mavlink/frames.h>
#include <tether/sim/geodesy.h>

namespace tether::autopilot {
namespace {

constexpr double kGaussPerTesla = 1e4;
constexpr double kPaPerHPa = 100.0;
// Which fields of HIL_SENSOR are new: all but the differential pressure.
constexpr std::uint32_t kAllButAirspeed = 0x7 | 0x38 | 0x1C0 | 0x1A00;
// The date of ET 0 of programs as they are, too.
constexpr Duration kEpoch = std::chrono::seconds(1'767'225'600);  // 2026-01-01

std::int64_t to_us(Duration d) {
  return std::chrono::duration_cast<std::chrono::microseconds>(d).count();
}

}  // namespace

Readings ideal_readings(const uav::BodyState& truth, const uav::Vec3& specific_force_B_m_s2,
                        const sim::Place& place, const uav::Vec3& magnetic_field_W_T) {
  const sim::Geodetic at = sim::geodetic_of(place, truth.p_WB);
  constexpr double kAccuracy_m = 0.5, kAccuracy_m_s = 0.1;
  return {.specific_force_B_m_s2 = specific_force_B_m_s2,
          .w_WB_B_rad_s = truth.w_WB_B,
          .field_B_T = rotate(inverse(truth.q_WB), magnetic_field_W_T),
          .pressure_Pa = sim::standard_pressure_pa(at.altitude_m),
          .position = {.sampled_at = {},
                       .has_fix = true,
                       .latitude_deg = at.latitude_deg,
                       .longitude_deg = at.longitude_deg,
                       .altitude_m = at.altitude_m,
                       .velocity_ENU_m_s = sim::to_enu(place, truth.v_WB),
                       .horizontal_accuracy_m = kAccuracy_m,
                       .vertical_accuracy_m = kAccuracy_m,
                       .speed_accuracy_m_s = kAccuracy_m_s}};
}

Readings with_noise(Readings readings, std::uint64_t seed, std::uint64_t step) {
  constexpr double kForce_m_s2 = 0.03, kRate_rad_s = 0.002, kField_T = 1e-7, kPressure_Pa = 0.6;
  KeyedRandom random({seed, random_stream("controller", "", "own noise"), step});
  const auto add = [&](uav::Vec3& v, double stddev) {
    v.x += stddev * random.normal();
    v.y += stddev * random.normal();
    v.z += stddev * random.normal();
  };
  add(readings.specific_force_B_m_s2, kForce_m_s2);
  add(readings.w_WB_B_rad_s, kRate_rad_s);
  add(readings.field_B_T, kField_T);
  readings.pressure_Pa += kPressure_Pa * random.normal();
  return readings;
}

mavlink::Message hil_sensor(Duration at, const Readings& readings) {
  constexpr double kTemperature_degC = 25.0;
  const uav::Vec3 force = mavlink::frd_from_flu(readings.specific_force_B_m_s2);
  const uav::Vec3 rate = mavlink::frd_from_flu(readings.w_WB_B_rad_s);
  const uav::Vec3 field = kGaussPerTesla * mavlink::frd_from_flu(readings.field_B_T);
  mavlink::Message m("HIL_SENSOR");
  m.set("time_usec", to_us(at));
  m.set("xacc", force.x).set("yacc", force.y).set("zacc", force.z);
  m.set("xgyro", rate.x).set("ygyro", rate.y).set("zgyro", rate.z);
  m.set("xmag", field.x).set("ymag", field.y).set("zmag", field.z);
  m.set("abs_pressure", readings.pressure_Pa / kPaPerHPa);
  m.set("pressure_alt", sim::standard_altitude_m(readings.pressure_Pa));
  m.set("temperature", kTemperature_degC).set("fields_updated", kAllButAirspeed);
  return m;
}

mavlink::Message hil_gps(Duration at, const uav::NavSatSample& position) {
  constexpr int kFix3D = 3, kNoFix = 1, kSatellites = 10;
  constexpr double kDegE7 = 1e7, kMm = 1e3, kCm = 1e2, kLeastSpeed_m_s = 0.1;
  constexpr int kUnknown = 65535;
  mavlink::Message m("HIL_GPS");
  m.set("time_usec", to_us(kEpoch + at));
  m.set("eph", kUnknown).set("epv", kUnknown).set("vel", kUnknown).set("cog", kUnknown);
  m.set("fix_type", position.has_fix ? kFix3D : kNoFix);
  if (!position.has_fix) return m;
  const uav::Vec3 v_NED = mavlink::ned_from_enu(position.velocity_ENU_m_s);
  const double speed_m_s = std::hypot(v_NED.x, v_NED.y);
  m.set("lat", position.latitude_deg * kDegE7).set("lon", position.longitude_deg * kDegE7);
  m.set("alt", position.altitude_m * kMm).set("satellites_visible", kSatellites);
  m.set("eph", position.horizontal_accuracy_m * kCm);
  m.set("epv", position.vertical_accuracy_m * kCm);
  m.set("vn", v_NED.x * kCm).set("ve", v_NED.y * kCm).set("vd", v_NED.z * kCm);
  m.set("vel", speed_m_s * kCm);
  if (speed_m_s < kLeastSpeed_m_s) return m;
  const double course_deg = deg_from_rad(std::atan2(v_NED.y, v_NED.x));
  m.set("cog", kCm * (course_deg < 0.0 ? course_deg + 360.0 : course_deg));
  return m;
}

std::vector<double> rotor_speeds_rad_s(const mavlink::Message& controls, std::size_t rotors,
                                       double max_rad_s) {
  std::vector<double> speeds;
  for (std::size_t i = 0; i < rotors; ++i) {
    const double share = controls.number("controls", i);
    speeds.push_back(std::isfinite(share) ? max_rad_s * std::clamp(share, 0.0, 1.0) : 0.0);
  }
  return speeds;
}

}  // namespace tether::autopilot
