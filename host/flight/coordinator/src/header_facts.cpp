#include "header_facts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <variant>

#include <tether/radio/medium.h>

namespace tether::coordinator {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::infinity();

double radius_m(const sim::Geometry& geometry) {
  return std::visit(
      sim::Visitor{
          [](const sim::BoxGeometry& box) { return 0.5 * norm(box.size_m); },
          [](const sim::CylinderGeometry& c) { return std::hypot(c.radius_m, 0.5 * c.length_m); },
          [](const sim::SphereGeometry& sphere) { return sphere.radius_m; },
          [](const sim::CapsuleGeometry& c) { return c.radius_m + 0.5 * c.length_m; },
          [](const sim::EllipsoidGeometry& e) {
            return std::max({e.radii_m.x, e.radii_m.y, e.radii_m.z});
          },
          [](const sim::PlaneGeometry&) { return 0.0; },  // on a UAV, it collides with nothing
          [](const sim::MeshGeometry&) { return kUnknown; }},
      geometry);
}

}  // namespace

record::Setpoint record_of(const uav::Setpoint& setpoint) {
  record::Setpoint d{.mask = setpoint.mask, .in_heading = setpoint.in_heading};
  const auto copy = [](const uav::Vec3& v, double(&out)[3]) {
    std::tie(out[0], out[1], out[2]) = std::tie(v.x, v.y, v.z);
  };
  copy(setpoint.p_WB_m, d.p_WB_m);
  copy(setpoint.velocity_m_s, d.velocity_m_s);
  copy(setpoint.acceleration_m_s2, d.acceleration_m_s2);
  copy(setpoint.w_WB_B_rad_s, d.w_WB_B_rad_s);
  const auto& [w, x, y, z] = setpoint.q_WB;
  std::tie(d.q_WB[0], d.q_WB[1], d.q_WB[2], d.q_WB[3]) = std::tie(w, x, y, z);
  d.yaw_rad = setpoint.yaw_rad;
  d.yaw_rate_rad_s = setpoint.yaw_rate_rad_s;
  d.thrust_N = setpoint.thrust_N;
  d.rotor_speeds_rad_s = setpoint.rotor_speeds_rad_s;
  d.joints_rad = setpoint.joints_rad;
  return d;
}

record::RadioInfo describe(const radio::Settings& radio) {
  record::RadioInfo info{.model = "ideal",
                         .least_delay = radio::least_delay(radio),
                         .inbox_messages = radio.inbox_messages};
  if (radio.model == radio::Model::kIdeal) return info;
  info.data_rate_bit_s = radio.data_rate_bit_s;
  if (radio.model == radio::Model::kDistribution) {
    const Duration most = uav::bounds(radio.drawn_delay).second;
    info.model = "distribution";
    info.most_delay = most == Duration::max() ? most : radio.delay + most;
    info.loss_probability = radio.loss_probability;
    info.burst_begin_probability = radio.burst_begin_probability;
    info.burst_end_probability = radio.burst_end_probability;
    return info;
  }
  info.model = "log_distance";
  info.access = radio.access == radio::Access::kCsma ? "csma" : "tdma";
  info.queue_messages = radio.queue_messages;
  info.header_bytes = radio.header_bytes;
  info.delay = radio.delay;
  info.preamble = radio.preamble;
  info.slot = radio.slot;
  info.bandwidth_hz = radio.bandwidth_hz;
  info.tx_power_dbm = radio.tx_power_dbm;
  info.noise_figure_db = radio.noise_figure_db;
  info.reference_loss_db = radio.reference_loss_db;
  info.exponent = radio.exponent;
  info.shadowing_db = radio.shadowing_db;
  info.wall_loss_db = radio.wall_loss_db;
  return info;
}

std::optional<record::EnergyInfo> describe_energy(const sim::Uav& uav, double gravity_m_s2) {
  if (!uav.energy) return std::nullopt;
  const energy::Model& model = *uav.energy;
  record::EnergyInfo info{
      .capacity_C = model.battery.capacity_C,
      .resistance_ohm = model.battery.resistance_ohm,
      .initial_charge = model.battery.initial_charge,
      .voltage_at_charge = {},
      .lift_W = energy::propulsion_power_W(uav.airframe, model.propulsion,
                                           uav::hover_state(uav.airframe, gravity_m_s2, 0.0), {}),
      .idle_W = model.computer.idle_W,
      .busy_core_W = model.computer.busy_core_W,
      .sensors_W = model.sensors_W};
  for (const auto& [charge, voltage_V] : model.battery.voltage_at_charge)
    info.voltage_at_charge.push_back({charge, voltage_V});
  return info;
}

double extent_m(const sim::Link& body) {
  double extent = 0.0;
  for (const sim::Collision& collision : body.collisions)
    extent = std::max(extent, norm(collision.X_LC.p) + radius_m(collision.geometry));
  return std::isfinite(extent) ? extent : 0.0;
}

bool only_uavs_move(const sim::World& world) {
  return std::ranges::all_of(world.models, &sim::Model::is_static);
}

}  // namespace tether::coordinator
