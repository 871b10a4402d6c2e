#include "external/hil.h"

#include <algorithm>
#include <cmath>

#include <tether/base/units.h>
#include <tether/mavlink/frame.h>
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

std::vector<double> rotor_shares(const mavlink::Message& controls, std::size_t rotors) {
  std::vector<double> shares;
  for (std::size_t i = 0; i < rotors; ++i) {
    const double share = controls.number("controls", i);
    shares.push_back(std::isfinite(share) ? std::clamp(share, 0.0, 1.0) : 0.0);
  }
  return shares;
}

}  // namespace tether::autopilot
