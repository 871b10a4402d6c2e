#pragma once

#include "fields.h"

#include <tether/computer/clock.h>
#include <tether/record/messages.h>

/// Members of parts of a result that are of a record.
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

}  // namespace tether::campaign
