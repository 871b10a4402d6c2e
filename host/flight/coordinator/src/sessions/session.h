#pragma once

#include "sessions/received.h"
#include "sessions/validator.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <tether/base/random.h>
#include <tether/coordinator/coordinator.h>
#include <tether/link/messages.h>
#include <tether/link/server.h>
#include <tether/record/messages.h>
#include <tether/sim/simulator.h>
#include <tether/uav/sensor_timing.h>
#include <tether/uav/setpoint.h>

namespace tether::coordinator {

/// A request between its arrival and its reply.
struct PendingInteraction {
  link::Request request{};
  record::Interaction entry;           ///< complete when the reply is sent
  std::optional<Received> received{};  ///< has arrived for this call
};

/// The state of one SUT and its UAV.
struct Session {
  std::size_t uav = 0;  ///< index of the UAV in the world, and of its SUT's time in Timelines
  std::string uav_name;
  uav::Delay command_latency;
  RandomKey latency_key;  ///< of command 0
  uav::FlightLimits limits{};
  int cores = 0;  ///< of the SUT's machine; 0: not known
  /// For each sensor, the sampling time of the last recorded image.
  std::vector<std::optional<SimTime>> recorded_image_at;

  // From the Hello on.
  link::PeerId peer = 0;  ///< 0: not joined
  link::Hello hello;
  std::uint64_t next_sequence = 1;
  std::unique_ptr<GivenTime> replay;  ///< with the clock "replayed"
  AnnotationBudget annotations;
  std::optional<link::Finish> finish;

  std::vector<record::Annotation> notes;  ///< settled: to record before the next reply

  /// Requests without a reply, in order; at most one for a serial SUT.
  std::vector<PendingInteraction> open;
  std::uint32_t received_bytes = 0;  ///< of its newest reply, if that takes long to arrive
  std::uint64_t moved_bytes = 0;     ///< of link::Server, when the limits were last checked
  Duration computed{0};         ///< of RunHooks::computed_by, when the limits were last checked
  Duration computed_before{0};  ///< that, when the SUT's bound was last seen to grow
  ExecTime last_bound;          ///< then

  bool joined() const { return peer != 0; }
  /// With the clock "replayed": what each stage takes until the next call.
  std::vector<link::StageTime> time_given() const {
    return replay ? replay->given() : std::vector<link::StageTime>();
  }
};

}  // namespace tether::coordinator
