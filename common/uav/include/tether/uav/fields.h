#pragma once

#include <cmath>
#include <cstdint>

#include <tether/uav/catalogue.h>
#include <tether/uav/math.h>
#include <tether/uav/multirotor.h>
#include <tether/uav/samples.h>
#include <tether/wire/fields.h>

/// The fields of what is sent of a UAV: tether/wire/fields.h.
namespace tether::wire {

template <>
inline constexpr bool kIsStruct<uav::Vec3> = true;
template <>
inline constexpr bool kIsStruct<uav::Quat> = true;
template <>
inline constexpr bool kIsStruct<uav::Pose> = true;
template <>
inline constexpr bool kIsStruct<uav::Rotor> = true;
template <>
inline constexpr bool kIsStruct<uav::BodyState> = true;

}  // namespace tether::wire

namespace tether::uav {

using wire::Is;

/// Most bytes of an image: those of 4096×4096 pixels with colours and depths.
inline constexpr std::size_t kMaxImageBytes = (128u << 20) - 4096;

/// A rule on a number, for each part of a vector.
constexpr auto of_each_part(const auto& rule) {
  return wire::Rule{
      [rule](const Vec3& v) { return rule.holds(v.x) && rule.holds(v.y) && rule.holds(v.z); },
      rule.text};
}

constexpr void fields(auto& io, Is<Vec3> auto& v) {
  io("x", v.x);
  io("y", v.y);
  io("z", v.z);
}
/// Rotations are used without being normalised.
constexpr void fields(auto& io, Is<Quat> auto& q) {
  io("w", q.w);
  io("x", q.x);
  io("y", q.y);
  io("z", q.z);
  io.require([&q] { return std::abs(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z - 1.0) < 1e-6; },
             "q", "is not a unit quaternion");
}
constexpr void fields(auto& io, Is<Pose> auto& X) {
  io("p", X.p);
  io("q", X.q);
}
constexpr void fields(auto& io, Is<BodyState> auto& s) {
  io("p_wb", s.p_WB);
  io("q_wb", s.q_WB);
  io("v_wb", s.v_WB);
  io("w_wb_b", s.w_WB_B);
}
constexpr void fields(auto& io, Is<Rotor> auto& rotor) {
  io("p_br", rotor.p_BR);
  io("direction", rotor.direction,
     wire::Rule{[](int d) { return d == 1 || d == -1; }, "have a direction other than 1 or -1"});
}

void fields(auto& io, Is<MultirotorParameters> auto& m) {
  using wire::kNotNegative;
  io("mass_kg", m.mass_kg, wire::kPositive);
  io("inertia_kg_m2", m.inertia_kg_m2, of_each_part(wire::kPositive));
  io("rotors", m.rotors, wire::AtMost{MultirotorState::kMaxRotors, "are not 1 to 8"},
     wire::Rule{[](const auto& rotors) { return !rotors.empty(); }, "are not 1 to 8"});
  io("thrust_coefficient", m.thrust_coefficient, kNotNegative);
  io("moment_coefficient_m", m.moment_coefficient_m, kNotNegative);
  io("drag_coefficient", m.drag_coefficient, kNotNegative);
  io("linear_drag_n_s_m", m.linear_drag_N_s_m, kNotNegative);
  io("max_rotor_speed_rad_s", m.max_rotor_speed_rad_s, kNotNegative);
  io("time_constant_up_s", m.time_constant_up_s, kNotNegative);
  io("time_constant_down_s", m.time_constant_down_s, kNotNegative);
  io("max_tilt_rad", m.max_tilt_rad, kNotNegative);
  io("max_horizontal_speed_m_s", m.max_horizontal_speed_m_s, kNotNegative);
  io("max_vertical_speed_m_s", m.max_vertical_speed_m_s, kNotNegative);
  io("max_yaw_rate_rad_s", m.max_yaw_rate_rad_s, kNotNegative);
  io("max_acceleration_m_s2", m.max_acceleration_m_s2, kNotNegative);
  io("max_yaw_acceleration_rad_s2", m.max_yaw_acceleration_rad_s2, kNotNegative);
}

// --- commands -----------------------------------------------------------------------------------

void fields(auto& io, Is<Setpoint> auto& m) {
  io("mask", m.mask);
  io("in_heading", m.in_heading);
  io("p_wb_m", m.p_WB_m);
  io("velocity_m_s", m.velocity_m_s);
  io("acceleration_m_s2", m.acceleration_m_s2);
  io("yaw_rad", m.yaw_rad);
  io("yaw_rate_rad_s", m.yaw_rate_rad_s);
  io("q_wb", m.q_WB);
  io("w_wb_b_rad_s", m.w_WB_B_rad_s);
  io("thrust_n", m.thrust_N);
  io("rotor_speeds_rad_s", m.rotor_speeds_rad_s, wire::OmitEmpty{},
     wire::AtMost{MultirotorState::kMaxRotors});
  io("joints_rad", m.joints_rad, wire::OmitEmpty{}, wire::AtMost{kMaxJoints});
  io.require([&m] { return complaint_about(m).empty(); }, "set-point",
             [&m] { return "is invalid: " + complaint_about(m); });
}
void fields(auto& io, Is<TimedSetpoint> auto& m) {
  io("after_ns", m.after);
  io("setpoint", m.setpoint);
}

// --- catalogue ----------------------------------------------------------------------------------

void limit_fields(auto& io, auto& m) {
  io("min_m", m.min_m);
  io("max_m", m.max_m);
  io.require([&m] { return m.min_m >= 0.0 && m.min_m <= m.max_m; }, "min_m",
             "is not within 0..max_m");
}

void fields(auto& io, Is<CameraProperties> auto& m) {
  auto& camera = m.model;
  const wire::Rule side{[](int px) { return px > 0 && px <= 1 << 16; },
                        "of the image size is not within 1..65536 pixels"};
  const wire::Rule focal{[](double px) { return px > 0.0; },
                         "is a focal length that is not positive"};
  io("width_px", camera.width_px, side);
  io("height_px", camera.height_px, side);
  io("fx_px", camera.fx_px, focal);
  io("fy_px", camera.fy_px, focal);
  io("cx_px", camera.cx_px);
  io("cy_px", camera.cy_px);
  io("k1", camera.k1);
  io("k2", camera.k2);
  io("k3", camera.k3);
  io("p1", camera.p1);
  io("p2", camera.p2);
  io("kind", m.kind, wire::known_up_to(CameraKind::kSegmentation));
  limit_fields(io, m);
  io("models", m.models, wire::OmitEmpty{}, wire::AtMost{kMaxModels},
     wire::EachAtMost{kMaxNameBytes});
}
void fields(auto&, Is<ImuProperties> auto&) {}
void fields(auto& io, Is<RangeProperties> auto& m) {
  limit_fields(io, m);
}

void fields(auto&, Is<NavSatProperties> auto&) {}
void fields(auto&, Is<MagnetometerProperties> auto&) {}
void fields(auto&, Is<BarometerProperties> auto&) {}
void fields(auto&, Is<OdometryProperties> auto&) {}
void fields(auto& io, Is<ScanProperties> auto& m) {
  io("columns", m.columns);
  io("rows", m.rows);
  io("min_azimuth_rad", m.min_azimuth_rad);
  io("max_azimuth_rad", m.max_azimuth_rad);
  io("min_elevation_rad", m.min_elevation_rad);
  io("max_elevation_rad", m.max_elevation_rad);
  limit_fields(io, m);
  io("sweep_s", m.sweep_s, wire::kNotNegative);
  io.require(
      [&m] {
        return m.columns > 0 && m.rows > 0 &&
               std::int64_t{m.columns} * m.rows <= std::int64_t{kMaxScanRays};
      },
      "columns x rows", "is not within 1..262144");
}

void fields(auto&, Is<JointStateProperties> auto&) {}

void fields(auto& io, Is<SensorDescription> auto& m) {
  io.here([&m] { return "sensor '" + m.name.substr(0, kMaxNameBytes) + "': "; });
  io("name", m.name, wire::AtMost{kMaxNameBytes}, wire::kNotEmpty);
  io("x_bs", m.X_BS);
  io("rate_hz", m.rate_hz, wire::kNotNegative);
  io("properties", m.properties);
  io("own_stamps", m.own_stamps);
  io("joints", m.joints);
}

void fields(auto& io, Is<Anchor> auto& m) {
  io.here([&m] { return "anchor '" + m.name.substr(0, kMaxNameBytes) + "': "; });
  io("name", m.name, wire::AtMost{kMaxNameBytes}, wire::kNotEmpty);
  io("shape", m.shape, wire::known_up_to(AnchorShape::kSphere));
  io("size_m", m.size_m, of_each_part(wire::kNotNegative));
  io("color_rgb", m.color_rgb, of_each_part(wire::kShare));
}

void fields(auto& io, Is<Joint> auto& m) {
  io.here([&m] { return "joint '" + m.name.substr(0, kMaxNameBytes) + "': "; });
  io("name", m.name, wire::AtMost{kMaxNameBytes}, wire::kNotEmpty);
  io("p_bj", m.p_BJ);
  io("axis_b", m.axis_B);
  io("min_rad", m.min_rad);
  io("max_rad", m.max_rad);
  io("max_rate_rad_s", m.max_rate_rad_s, wire::kPositive);
  io.require([&m] { return m.min_rad <= m.max_rad; }, "min_rad", "is above max_rad");
}

void fields(auto& io, Is<Catalogue> auto& m) {
  constexpr const char* kTwice = "have the same name twice";
  io("uav", m.uav, wire::AtMost{kMaxNameBytes});
  io("sensors", m.sensors, wire::AtMost{kMaxCatalogueEntries},
     wire::unique_by(&SensorDescription::name, kTwice));
  io("anchors", m.anchors, wire::AtMost{kMaxCatalogueEntries},
     wire::unique_by(&Anchor::name, kTwice));
  io("battery_capacity_c", m.battery_capacity_C, wire::kNotNegative);
  io("rotors", m.limits.rotors);
  io("max_rotor_speed_rad_s", m.limits.max_rotor_speed_rad_s, wire::kNotNegative);
  io("max_thrust_n", m.limits.max_thrust_N, wire::kNotNegative);
  io("joints", m.limits.joints, wire::OmitEmpty{}, wire::AtMost{kMaxJoints});
  io.require(
      [&m] {
        for (const SensorDescription& sensor : m.sensors)
          if (sensor.joints > m.limits.joints.size()) return false;
        return true;
      },
      "sensors", "are behind more joints than there are");
}

// --- samples ------------------------------------------------------------------------------------

void fields(auto& io, Is<CameraSample> auto& m) {
  io("sampled_at_st_ns", m.sampled_at);
  io("index", m.index);
  io("width_px", m.width_px);
  io("height_px", m.height_px);
  io("rgb", m.rgb, wire::Apart{});
  io("depth_m", m.depth_m, wire::OmitEmpty{});
  io("labels", m.labels, wire::OmitEmpty{});
  const auto is_whole = [&m](std::size_t size, std::size_t per_pixel) {
    const std::int64_t pixels = std::int64_t{m.width_px} * m.height_px;
    return size == 0 ||
           (size % per_pixel == 0 && static_cast<std::int64_t>(size / per_pixel) == pixels);
  };
  io.require([&] { return m.width_px > 0 && m.height_px > 0; }, "image size", "is not positive");
  io.require([&] { return !m.rgb.empty() || !m.depth_m.empty() || !m.labels.empty(); }, "image",
             "is empty");
  io.require([&] { return is_whole(m.rgb.size(), 3); }, "image", "is not width x height x 3 bytes");
  io.require([&] { return is_whole(m.depth_m.size(), 1); }, "depth_m",
             "is not width x height numbers");
  io.require([&] { return is_whole(m.labels.size(), 1); }, "labels",
             "is not width x height numbers");
  io.require(
      [&] { return m.rgb.size() + 4 * m.depth_m.size() + 2 * m.labels.size() <= kMaxImageBytes; },
      "image", "is larger than a frame may be");
}
void fields(auto& io, Is<ImuSample> auto& m) {
  io("sampled_at_st_ns", m.sampled_at);
  io("index", m.index);
  io("angular_velocity_rad_s", m.angular_velocity_rad_s);
  io("specific_force_m_s2", m.specific_force_m_s2);
  io("q_ws", m.q_WS);
}
void fields(auto& io, Is<RangeSample> auto& m) {
  io("sampled_at_st_ns", m.sampled_at);
  io("index", m.index);
  io("range_m", m.range_m, wire::AnyNumber{}, wire::kNoNan);
}
void fields(auto& io, Is<NavSatSample> auto& m) {
  io("sampled_at_st_ns", m.sampled_at);
  io("index", m.index);
  io("has_fix", m.has_fix);
  io("latitude_deg", m.latitude_deg, wire::AnyNumber{});
  io("longitude_deg", m.longitude_deg, wire::AnyNumber{});
  io("altitude_m", m.altitude_m, wire::AnyNumber{});
  io("east_m_s", m.velocity_ENU_m_s.x, wire::AnyNumber{});
  io("north_m_s", m.velocity_ENU_m_s.y, wire::AnyNumber{});
  io("up_m_s", m.velocity_ENU_m_s.z, wire::AnyNumber{});
  io("horizontal_accuracy_m", m.horizontal_accuracy_m, wire::AnyNumber{});
  io("vertical_accuracy_m", m.vertical_accuracy_m, wire::AnyNumber{});
  io("speed_accuracy_m_s", m.speed_accuracy_m_s, wire::AnyNumber{});
  io.require([&m] { return !m.has_fix || std::abs(m.latitude_deg) <= 90.0; }, "latitude_deg",
             "is not within -90..90");
}
void fields(auto& io, Is<MagnetometerSample> auto& m) {
  io("sampled_at_st_ns", m.sampled_at);
  io("index", m.index);
  io("field_t", m.field_T);
}
void fields(auto& io, Is<BarometerSample> auto& m) {
  io("sampled_at_st_ns", m.sampled_at);
  io("index", m.index);
  io("pressure_pa", m.pressure_Pa);
  io("altitude_m", m.altitude_m);
}
void fields(auto& io, Is<OdometrySample> auto& m) {
  io("sampled_at_st_ns", m.sampled_at);
  io("index", m.index);
  io("p_ws", m.p_WS);
  io("q_ws", m.q_WS);
  io("v_ws_m_s", m.v_WS_m_s);
  io("w_ws_rad_s", m.w_WS_rad_s);
  io("position_stddev_m", m.position_stddev_m);
  io("attitude_stddev_rad", m.attitude_stddev_rad);
  io("velocity_stddev_m_s", m.velocity_stddev_m_s);
}
void fields(auto& io, Is<ScanSample> auto& m) {
  io("sampled_at_st_ns", m.sampled_at);
  io("index", m.index);
  io("ranges_m", m.ranges_m, wire::AtMost{kMaxScanRays, "has too many rays"});
  io("intensities", m.intensities, wire::OmitEmpty{}, wire::AtMost{kMaxScanRays});
  io.require([&m] { return m.intensities.empty() || m.intensities.size() == m.ranges_m.size(); },
             "intensities", "are not as many as the ranges");
}
void fields(auto& io, Is<JointStateSample> auto& m) {
  io("sampled_at_st_ns", m.sampled_at);
  io("index", m.index);
  io("angles_rad", m.angles_rad, wire::OmitEmpty{}, wire::AtMost{kMaxJoints});
}
void fields(auto& io, Is<BatterySample> auto& m) {
  io("sampled_at_st_ns", m.sampled_at);
  io("voltage_v", m.voltage_V);
  io("current_a", m.current_A);
  io("charge", m.charge, wire::kShare);
}

}  // namespace tether::uav
