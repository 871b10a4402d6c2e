#pragma once

#include <concepts>
#include <type_traits>

#include <tether/record/header.h>

/// Of the list in members.h: the members of a record's header.
namespace tether::record {

template <class Message, class Plain>
concept Maybe = std::same_as<std::remove_const_t<Message>, Plain>;

inline constexpr int kLargestSide_px = 100'000;

void members(auto& io, Maybe<computer::Clock> auto& m) {
  io("clock", m.kind);
  io("cpu_factor", m.factor);
  if (io.has("computing_ns", m.computing > Duration(0))) io("computing_ns", m.computing);
}

void members(auto& io, Maybe<ReplayInfo> auto& m) {
  io("timing", m.timing);
  io("mode", m.mode);
  io("recorded_at", m.recorded_at);
  io("board", m.board);
  io("build_id", m.build_id);
}

void members(auto& io, Maybe<ChargeVoltage> auto& m) {
  io("charge", m.charge);
  io("voltage_v", m.voltage_V);
}

void members(auto& io, Maybe<EnergyInfo> auto& m) {
  io.positive("capacity_c", m.capacity_C);
  io("resistance_ohm", m.resistance_ohm);
  io("initial_charge", m.initial_charge);
  io.list("voltage_at_charge", m.voltage_at_charge);
  io("lift_w", m.lift_W);
  io("idle_w", m.idle_W);
  io("busy_core_w", m.busy_core_W);
  io("sensors_w", m.sensors_W);
}

void members(auto& io, Maybe<BuildPart> auto& m) {
  io("name", m.name);
  io("value", m.value);
}

void members(auto& io, Maybe<ControllerInfo> auto& m) {
  io("name", m.name);
  io("estimate", m.estimate);
  io("period_ns", m.period);
  io("link_baud", m.link_baud);
  io("link_latency_ns", m.link_latency);
}

void members(auto& io, Maybe<JointInfo> auto& m) {
  io("name", m.name);
  io("p_BJ_m", m.p_BJ_m);
  io("axis_B", m.axis_B);
  io("min_rad", m.min_rad);
  io("max_rad", m.max_rad);
  io.positive("max_rate_rad_s", m.max_rate_rad_s);
}

void members(auto& io, Maybe<PayloadInfo> auto& m) {
  io.positive("mass_kg", m.mass_kg);
  io("from_ns", m.from);
  if (io.has("until_ns", m.until != SimTime::max())) io("until_ns", m.until);
}

void members(auto& io, Maybe<LoadInfo> auto& m) {
  io.positive("own_mass_kg", m.own_mass_kg);
  io("gravity_m_s2", m.gravity_m_s2);
  io.list("payloads", m.payloads);
}

void members(auto& io, Maybe<SutInfo> auto& m) {
  constexpr int kMostCores = 1024;
  io("uav", m.uav);
  io("sut", m.sut);
  io("clock", m.clock.kind);
  io("cpu_factor", m.clock.factor);
  io("command_latency_ns", m.command_latency);
  io.optional("max_command_latency_ns", m.max_command_latency);
  if (io.has("setpoint_timeout_ns", m.setpoint_timeout > Duration(0))) {
    io("setpoint_timeout_ns", m.setpoint_timeout);
    io("on_setpoint_loss", m.on_setpoint_loss);
  }
  if (io.has("controller", m.controller.has_value()))
    io.object("controller",
              [&](auto& controller) { members(controller, io.value_of(m.controller)); });
  io.flag("concurrent", m.concurrent);
  if (io.has("cores", m.cores > 0)) io.within("cores", m.cores, 1, kMostCores);
  if (io.has("max_acceleration_m_s2", m.max_acceleration_m_s2 > 0.0))
    io.positive("max_acceleration_m_s2", m.max_acceleration_m_s2);
  if (io.has("computing_ns", m.clock.computing > Duration(0)))
    io("computing_ns", m.clock.computing);
  if (io.has("required_clock", m.required_clock.has_value()))
    io.object("required_clock",
              [&](auto& clock) { members(clock, io.value_of(m.required_clock)); });
  if (io.has("build_id", !m.build_id.empty())) io("build_id", m.build_id);
  if (io.has("build", !m.build.empty())) io.list("build", m.build);
  if (io.has("replay", m.replay.has_value()))
    io.object("replay", [&](auto& replay) { members(replay, io.value_of(m.replay)); });
  if (io.has("computer", !m.computer.empty())) io("computer", m.computer);
  if (io.has("launcher", !m.launcher.empty())) io("launcher", m.launcher);
  if (io.has("as_is", m.as_is)) io("as_is", m.as_is);
  if (io.has("extent_m", m.extent_m > 0.0)) io.positive("extent_m", m.extent_m);
  if (io.has("max_angular_acceleration_rad_s2", m.max_angular_acceleration_rad_s2 > 0.0))
    io.positive("max_angular_acceleration_rad_s2", m.max_angular_acceleration_rad_s2);
  if (io.has("energy", m.energy.has_value()))
    io.object("energy", [&](auto& energy) { members(energy, io.value_of(m.energy)); });
  if (io.has("joints", !m.joints.empty())) io.list("joints", m.joints);
  if (io.has("load", m.load.has_value()))
    io.object("load", [&](auto& load) { members(load, io.value_of(m.load)); });
  if (!io.has("board", !m.board.empty())) return;
  io("board", m.board);
  if (io.has("pinned_core", m.pinned_core.has_value()))
    io.within("pinned_core", io.value_of(m.pinned_core), 0, kMostCores - 1);
}

void members(auto& io, Maybe<BoardInfo> auto& m) {
  constexpr int kMostCores = 4096;
  io("name", m.name);
  if (io.has("is_real", m.is_real)) io("is_real", m.is_real);
  io.within("cores", m.cores, m.is_real ? 0 : 1, kMostCores);
}

void members(auto& io, Maybe<CameraInfo> auto& m) {
  io("p_BS_m", m.p_BS_m);
  io("q_BS", m.q_BS);
  io.within("width_px", m.width_px, 1, kLargestSide_px);
  io.within("height_px", m.height_px, 1, kLargestSide_px);
  io.positive("fx_px", m.fx_px);
  io.positive("fy_px", m.fy_px);
  io("cx_px", m.cx_px);
  io("cy_px", m.cy_px);
  io("k1", m.k1);
  io("k2", m.k2);
  io("k3", m.k3);
  io("p1", m.p1);
  io("p2", m.p2);
  if (io.has("depth_max_m", m.depth_max_m > 0.0)) {
    io("depth_min_m", m.depth_min_m);
    io("depth_max_m", m.depth_max_m);
  }
  if (io.has("models", !m.models.empty())) io.list("models", m.models);
  if (io.has("joints", m.joints > 0)) io("joints", m.joints);
}

void members(auto& io, Maybe<DriverInfo> auto& m) {
  constexpr int kBillion = 1'000'000'000;
  io("stamp_offset_ns", m.stamp_offset);
  io("stamp_jitter_ns", m.stamp_jitter);
  io.within("stamp_drift_ppb", m.stamp_drift_ppb, -kBillion, kBillion);
  io("lost_probability", m.lost_probability);
  io("repeated_probability", m.repeated_probability);
}

/// Records of Tether 0.1.0 have neither bounds of the delay nor cameras.
void members(auto& io, Maybe<SensorInfo> auto& m) {
  io("uav", m.uav);
  io("name", m.name);
  io("kind", m.kind);
  io("periodic", m.periodic);
  io("period_ns", m.period);
  io("phase_ns", m.phase);
  if (io.has("delay_min_ns", true)) io("delay_min_ns", m.delay_min);
  if (io.has("delay_max_ns", true)) io("delay_max_ns", m.delay_max);
  if (io.has("camera", m.camera.has_value()))
    io.object("camera", [&](auto& camera) { members(camera, io.value_of(m.camera)); });
  if (io.has("driver", m.driver.has_value()))
    io.object("driver", [&](auto& driver) { members(driver, io.value_of(m.driver)); });
}

void members(auto& io, Maybe<Waypoint> auto& m) {
  io("at_ns", m.at);
  io("p_m", m.p_m);
  io("yaw_rad", m.yaw_rad);
}

void members(auto& io, Maybe<Anchor> auto& m) {
  io("name", m.name);
  io("shape", m.shape);
  io("size_m", m.size_m);
  io("p_WA_m", m.p_WA_m);
  io("q_WA", m.q_WA);
  if (io.has("uav", !m.uav.empty())) {
    io("uav", m.uav);
    io("p_BA_m", m.p_BA_m);
  }
  if (!io.has("path", !m.path.empty())) return;
  io.list("path", m.path);
  io.flag("path_repeats", m.path_repeats);
  io("path_delay_ns", m.path_delay);
  io("p_WO_m", m.p_WO_m);
}

void members(auto& io, Maybe<WorkCost> auto& m) {
  io("work", m.work);
  io("ns", m.ns);
}

/// Those of "log_distance" only with that model.
void radio_members(auto& io, Maybe<RadioInfo> auto& m) {
  io("radio", m.model);
  io("radio_least_delay_ns", m.least_delay);
  io("radio_data_rate_bit_s", m.data_rate_bit_s);
  if (!io.has("radio_inbox_messages", m.inbox_messages > 0)) return;
  io("radio_inbox_messages", m.inbox_messages);
  if (io.has("radio_most_delay_ns", m.model == "distribution")) {
    io("radio_most_delay_ns", m.most_delay);
    io("radio_loss_probability", m.loss_probability);
    io("radio_burst_begin_probability", m.burst_begin_probability);
    io("radio_burst_end_probability", m.burst_end_probability);
  }
  if (!io.has("radio_access", !m.access.empty())) return;
  io("radio_access", m.access);
  io("radio_queue_messages", m.queue_messages);
  io("radio_header_bytes", m.header_bytes);
  io("radio_delay_ns", m.delay);
  io("radio_preamble_ns", m.preamble);
  io("radio_slot_ns", m.slot);
  io("radio_bandwidth_hz", m.bandwidth_hz);
  io("radio_tx_power_dbm", m.tx_power_dbm);
  io("radio_noise_figure_db", m.noise_figure_db);
  io("radio_reference_loss_db", m.reference_loss_db);
  io("radio_exponent", m.exponent);
  io("radio_shadowing_db", m.shadowing_db);
  io("radio_wall_loss_db", m.wall_loss_db);
}

/// All but the target.
void members(auto& io, Maybe<Header> auto& m) {
  io("schema_version", m.schema_version);
  io("tether_version", m.tether_version);
  io("scenario", m.scenario);
  io("condition", m.condition);
  io("policy", m.policy);
  io("simulator", m.simulator);
  io("machine", m.machine);
  io("seed", m.seed);
  io("step_ns", m.step);
  io("ground_truth_period_ns", m.ground_truth_period);
  io("real_time_factor", m.real_time_factor);
  if (io.has("time_limit_ns", m.time_limit > Duration(0))) io("time_limit_ns", m.time_limit);
  io.list("suts", m.suts);
  io.list("sensors", m.sensors);
  io.list("anchors", m.anchors);
  if (io.has("wall_at_start_ns", m.wall_at_start != WallTime{}))
    io("wall_at_start_ns", m.wall_at_start);
  io.flag("reports_contacts", m.reports_contacts);
  io.flag("only_uavs_move", m.only_uavs_move);
  io.flag("moves_by_forces", m.moves_by_forces);
  if (io.has("radio", !m.radio.model.empty())) radio_members(io, m.radio);
  if (io.has("boards", !m.boards.empty())) io.list("boards", m.boards);
  if (!io.has("emulator", !m.emulator.program.empty())) return;
  io("emulator", m.emulator.program);
  io("cpu_model", m.emulator.cpu_model);
  io.list("costs", m.emulator.costs);
}

}  // namespace tether::record
