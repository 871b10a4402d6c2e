#pragma once

#include "fields.h"

#include <tether/computer/clock.h>
#include <tether/record/messages.h>
#include <tether/timing/pace.h>

/// The pace of a result, and parts of it that others have, too.
namespace tether::campaign {

/// For the object of a SUT or a trial.
void fields(auto& io, Maybe<computer::Clock> auto& m) {
  io.word("clock", m.kind, computer::kClockKinds);
  io("cpu_factor", m.factor);
  if (io.has("computing_s", m.kind == computer::ClockKind::kScripted))
    io("computing_s", m.computing);
}

void fields(auto& io, Maybe<record::ReplayInfo> auto& m) {
  io("timing", m.timing);
  io("mode", m.mode);
  io("recorded_at", m.recorded_at);
  io("board", m.board);
  io("build_id", m.build_id);
}

void fields(auto& io, Maybe<record::WorkCost> auto& m) {
  io("work", m.work);
  io("ns", m.ns);
}

void fields(auto& io, Maybe<record::EmulatorInfo> auto& m) {
  io("program", m.program);
  io("cpu_model", m.cpu_model);
  io("costs", m.costs);
}

void fields(auto& io, Maybe<record::BoardInfo> auto& m) {
  io("name", m.name);
  io("cores", m.cores);
  io("is_real", m.is_real);
}

void fields(auto& io, Maybe<timing::StageRow> auto& m) {
  io("stage", m.stage);
  io("count", m.count);
  io("median_s", m.median_s);
  io("p95_s", m.p95_s);
  io("p99_s", m.p99_s);
  io("worst_s", m.worst_s);
  io("share", m.share);
}

void fields(auto& io, Maybe<timing::BoardPace> auto& m) {
  io("board", m.board);
  io("uavs", m.uavs);
  io("median_s", m.median_s);
  io("p95_s", m.p95_s);
  io.optional("alone", m.alone);
}

void fields(auto& io, Maybe<timing::Speed::Program> auto& m) {
  io("uav", m.uav);
  fields(io, m.clock);
  io.optional("replay", m.replay);
  io.some("board", m.board);
  io.some("computer", m.computer);
  io.some("launcher", m.launcher);
  io("concurrent", m.concurrent);
  io.some("build", m.build);
  io.some("libraries", m.libraries);
  io.some("loader", m.loader);
  io.optional("pinned_core", m.pinned_core);
  io("idle_w", m.idle_W);
  io("busy_core_w", m.busy_core_W);
  if (io.has("cores", m.cores > 0)) io("cores", m.cores);
}

/// Without the emulator, which the result has.
void fields(auto& io, Maybe<timing::Speed> auto& m) {
  io("programs", m.programs);
  io.some("boards", m.boards);
  io.some("machine", m.machine);
  io.some("target", m.target);
}

void fields(auto& io, Maybe<timing::Pace::Losses> auto& m) {
  io("count", m.count);
  io("first_at_s", m.first_at);
  io("uav", m.uav);
  io("action", m.action);
}

void fields(auto& io, Maybe<timing::Pace::Unqueued> auto& m) {
  io("uav", m.uav);
  io("sensor", m.sensor);
  io("count", m.count);
}

/// Without the seed, which the result has.
void fields(auto& io, Maybe<timing::Pace> auto& m) {
  io("uav", m.uav);
  io("stages", m.stages);
  if (io.has("camera", !m.camera.empty())) {
    io("camera", m.camera);
    io("images", m.images);
    io("read_hz", m.read_hz);
    io.optional("offered_hz", m.offered_hz);
    io("median_s", m.median_s);
    io("p95_s", m.p95_s);
    io("waiting", m.waiting);
    if (io.has("behind", m.behind > 0.0)) io("behind", m.behind);
    if (io.has("reading", m.reading < 1.0)) io("reading", m.reading);
  }
  if (io.has("setpoint_hz", m.setpoint_hz > 0.0)) {
    io("setpoint_hz", m.setpoint_hz);
    io("setpoint_gap_s", m.setpoint_gap_s);
  }
  if (io.has("losses", m.losses.count > 0)) io("losses", m.losses);
  io.some("unqueued", m.unqueued);
  if (io.has("unclear", !m.unclear.empty())) io("unclear", m.unclear);
  io("shares_real_board", m.shares_real_board);
  if (io.has("shared_board", !m.shared_board.empty())) {
    io("shared_board", m.shared_board);
    io("programs", m.programs);
  }
  io.some("boards", m.boards);
  io("speed", m.speed);
  if (!io.has("radio", !m.radio.empty())) return;
  io("radio", m.radio);
  io("messages", m.messages);
  io("messages_arrived", m.messages_arrived);
}

}  // namespace tether::campaign
