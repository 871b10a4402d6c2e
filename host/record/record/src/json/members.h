#pragma once

#include "json/header_members.h"

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

inline bool found_nothing(const Interaction& read) {
  return read.only_if_available && !read.sampled_at;
}

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
  if (io.has("received_more", m.received_more > 0)) io("received_more", m.received_more);
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
  io.flag("of_station", m.of_station);
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
