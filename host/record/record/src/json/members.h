#pragma once

#include <concepts>
#include <type_traits>

#include <tether/record/messages.h>
#include <tether/record/writer.h>

/// The one list of the members of each message and each part of a record's metadata, for both
/// directions. `io` is a writer or a reader: see json_members.h and json_metadata.cpp. It has
/// - `io(name, value)`: writes or reads the member;
/// - `io.has(name, condition)`: whether the member is there: writers return the condition;
/// - `io.optional(name, value)`: a member that may be absent;
/// - `io.within(name, value, least, most)`, `io.positive(name, value)`: checked when read;
/// - `io.look_ahead(name, value)`: reads a member that comes later in the text;
/// - `io.flag(name, value)`: a truth value that is written only if it is true;
/// - `io.object(name, fields)`: a nested object, whose members `fields(io)` lists;
/// - `io.list(name, items)`: a list of objects.
/// The order is that of the text. Times are in nanoseconds; names carry the unit.
namespace tether::record {

template <class Message, class Plain>
concept Maybe = std::same_as<std::remove_const_t<Message>, Plain>;

inline bool found_nothing(const Interaction& read) {
  return read.only_if_available && !read.sampled_at;
}

inline constexpr int kLargestSide_px = 100'000;

void members(auto& io, Maybe<SeenAnchor> auto& m) {
  io("anchor", m.anchor);
  io.within("left_px", m.left_px, 0, kLargestSide_px);
  io.within("top_px", m.top_px, 0, kLargestSide_px);
  io.within("right_px", m.right_px, 0, kLargestSide_px);
  io.within("bottom_px", m.bottom_px, 0, kLargestSide_px);
  io("pixels", m.pixels);
}

void members(auto& io, Maybe<StageTime> auto& m) {
  io("stage", m.stage);
  io("computing_ns", m.computing);
  io.flag("unknown", m.is_unknown);
}

void members(auto& io, Maybe<ReceivedMessage> auto& m) {
  io("from", m.from);
  io("sequence", m.sequence);
  io("arrived_at_ns", m.arrived_at);
}

void members(auto& io, Maybe<BatteryReading> auto& m) {
  io("voltage_v", m.voltage_V);
  io("current_a", m.current_A);
  io("charge", m.charge);
}

void velocity_members(auto& io, auto& m) {
  io("vx_H_m_s", m.vx_H_m_s);
  io("vy_H_m_s", m.vy_H_m_s);
  io("vz_H_m_s", m.vz_H_m_s);
  io("yaw_rate_rad_s", m.yaw_rate_rad_s);
}

/// Those of the mask.
void members(auto& io, Maybe<Setpoint> auto& m) {
  io("mask", m.mask);
  if (io.has("after_ns", m.after > Duration(0))) io("after_ns", m.after);
  io.flag("in_heading", m.in_heading);
  const auto field = [&](std::uint64_t bit, const char* name, auto& value) {
    if ((m.mask & bit) != 0) io(name, value);
  };
  field(1, "p_WB_m", m.p_WB_m);
  field(2, "velocity_m_s", m.velocity_m_s);
  field(4, "acceleration_m_s2", m.acceleration_m_s2);
  field(8, "yaw_rad", m.yaw_rad);
  field(16, "yaw_rate_rad_s", m.yaw_rate_rad_s);
  field(32, "q_WB", m.q_WB);
  field(64, "w_WB_B_rad_s", m.w_WB_B_rad_s);
  field(128, "thrust_n", m.thrust_N);
  field(256, "rotor_speeds_rad_s", m.rotor_speeds_rad_s);
  field(512, "joints_rad", m.joints_rad);
}

void members(auto& io, Maybe<Interaction> auto& m) {
  io("uav", m.uav);
  io("sequence", m.sequence);
  io("kind", m.kind);
  io("request_at_ns", m.request_at);
  io("reply_at_ns", m.reply_at);
  if (m.kind == kSensor) {
    io("sensor", m.sensor);
    // The index comes first in the text. Whether there is one follows from these.
    io.look_ahead("only_if_available", m.only_if_available);
    io.look_ahead("sampled_at_ns", m.sampled_at);
    if (!found_nothing(m)) io("sample_index", m.sample_index);
    io("latest", m.latest);
    io.flag("only_if_available", m.only_if_available);
  }
  io.optional("sampled_at_ns", m.sampled_at);
  io.optional("sample_state_at_ns", m.sample_state_at);
  io.optional("available_at_ns", m.available_at);
  io.optional("sample_stamp_ns", m.sample_stamp);
  io.optional("repeated_index", m.repeated_index);
  io.optional("skipped_to", m.skipped_to);
  if (io.has("seen_anchors", m.seen_anchors.has_value()))
    io.list("seen_anchors", io.value_of(m.seen_anchors));
  io.optional("effect_at_ns", m.effect_at);
  if (io.has("command", m.command.has_value()))
    io.object("command", [&](auto& command) { velocity_members(command, io.value_of(m.command)); });
  if (io.has("setpoints", !m.setpoints.empty())) io.list("setpoints", m.setpoints);
  io.optional("command_latency_ns", m.command_latency);
  io.optional("sleep_until_ns", m.sleep_until);
  io.optional("receive_until_ns", m.receive_until);
  if (io.has("received", m.received.has_value()))
    io.object("received", [&](auto& received) { members(received, io.value_of(m.received)); });
  if (io.has("battery", m.battery.has_value()))
    io.object("battery", [&](auto& battery) { members(battery, io.value_of(m.battery)); });
  if (io.arrivals()) {
    io("st_at_arrival_ns", m.st_at_arrival);
    io("lag_ns", m.lag);
  }
  io("st_at_release_ns", m.st_at_release);
  io("grid_error_ns", m.grid_error);
  io("stamped", m.stamped);
  io.optional("violation", m.violation);
  if (io.has("stages", !m.stages.empty())) io.list("stages", m.stages);
  io.optional("computed_ns", m.computed);
  if (!io.wall()) return;
  io.object("wall", [&](auto& wall) {
    wall("arrival_ns", m.wall_at_arrival);
    wall("release_ns", m.wall_at_release);
    wall.optional("previous_link_ns", m.previous_link_time);
  });
}

void members(auto& io, Maybe<CommandEffect> auto& m) {
  io("uav", m.uav);
  io("sequence", m.sequence);
  io("applied_at_ns", m.applied_at);
  if (io.has("setpoint", m.setpoint.has_value()))
    io.object("setpoint", [&](auto& setpoint) { members(setpoint, io.value_of(m.setpoint)); });
  else
    velocity_members(io, m);
  if (io.has("index", m.index > 0)) io("index", m.index);
  if (io.has("loss", !m.loss.empty())) io("loss", m.loss);
}

void members(auto& io, Maybe<GroundTruth> auto& m) {
  io("uav", m.uav);
  io("at_ns", m.at);
  io("p_WB_m", m.p_WB_m);
  io("q_WB", m.q_WB);
  io("v_WB_m_s", m.v_WB_m_s);
  io("w_WB_B_rad_s", m.w_WB_B_rad_s);
  if (io.has("clearance_m", m.clearance_m.has_value()))
    io("clearance_m", io.value_of(m.clearance_m));
  if (io.has("joints_rad", !m.joints_rad.empty())) io("joints_rad", m.joints_rad);
}

void members(auto& io, Maybe<Stop> auto& m) {
  io("uav", m.uav);
  io("at_ns", m.at);
  io.optional("reply_at_ns", m.reply_at);
  if (io.wall()) io.object("wall", [&](auto& wall) { wall("arrival_ns", m.wall); });
}

void members(auto& io, Maybe<Contact> auto& m) {
  io("uav", m.uav);
  io("at_ns", m.at);
  io("with", m.with);
  io("speed_m_s", m.speed_m_s);
}

void members(auto& io, Maybe<RadioMessage> auto& m) {
  io("uav", m.uav);
  io("sequence", m.sequence);
  io("to", m.to);
  io("bytes", m.bytes);
  io("sent_at_ns", m.sent_at);
  io("at_ns", m.at);
  io("outcome", m.outcome);
  io.optional("began_at_ns", m.began_at);
  io.optional("distance_m", m.distance_m);
  io.optional("walls", m.walls);
  io.optional("snr_db", m.snr_db);
}

/// All but "fields".
void members(auto& io, Maybe<AutopilotMessage> auto& m) {
  io("uav", m.uav);
  io.flag("to_controller", m.to_controller);
  io("sequence", m.sequence);
  if (io.has("part", m.part > 0)) io("part", m.part);
  io("bytes", m.bytes);
  io("sent_at_ns", m.sent_at);
  io("at_ns", m.at);
  io.optional("acted_at_ns", m.acted_at);
  io("outcome", m.outcome);
  io("name", m.name);
}

void members(auto& io, Maybe<Battery> auto& m) {
  io("uav", m.uav);
  io("at_ns", m.at);
  io("voltage_v", m.voltage_V);
  io("current_a", m.current_A);
  io("charge", m.charge);
  io("lift_j", m.lift_J);
  io("moving_j", m.moving_J);
  io("idle_j", m.idle_J);
  io("computing_j", m.computing_J);
  io("sensors_j", m.sensors_J);
  io("resistance_j", m.resistance_J);
}

void members(auto& io, Maybe<Margin> auto& m) {
  io("uav", m.uav);
  io("clause", m.clause);
  io("at_ns", m.at);
  io("margin", m.margin);
  io("unit", m.unit);
}

void members(auto& io, Maybe<TopicCount> auto& m) {
  io("topic", m.topic);
  io("messages", m.messages);
}

void members(auto& io, Maybe<Clearance> auto& m) {
  io("uav", m.uav);
  io("min_m", m.min_m);
  io("at_ns", m.at);
  io("to", m.to);
}

/// All but "data", which is JSON of the SUT's.
void members(auto& io, Maybe<Annotation> auto& m) {
  io("uav", m.uav);
  io("at_ns", m.at);
  io("topic", m.topic);
}

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

/// All but the target's readings.
void members(auto& io, Maybe<Footer> auto& m) {
  io("end", m.end);
  io("reason", m.reason);
  io("st_at_end_ns", m.st_at_end);
  io.list("et_at_end_ns", m.et_at_end);
  io("wall_ns", m.wall);
  io("interactions", m.interactions);
  io("causality_violations", m.causality_violations);
  io("largest_lag_ns", m.largest_lag);
  io("largest_grid_error_ns", m.largest_grid_error);
  if (io.has("clearances", !m.clearances.empty())) io.list("clearances", m.clearances);
  if (io.has("expelled", !m.expelled.empty())) io.list("expelled", m.expelled);
  if (io.has("computing", !m.computing.empty())) io.list("computing", m.computing);
  if (io.has("topics", !m.topics.empty())) io.list("topics", m.topics);
  if (!io.has("stops", m.stops > 0)) return;
  io("stops", m.stops);
  io("largest_overshoot_ns", m.largest_overshoot);
}

}  // namespace tether::record
