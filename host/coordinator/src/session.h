#pragma once

#include "validator.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <tether/link/messages.h>
#include <tether/link/server.h>
#include <tether/record/messages.h>
#include <tether/sim/simulator.h>
#include <tether/sync/barrier_synchronizer.h>
#include <tether/sync/clock_witness.h>
#include <tether/sync/execution_timer.h>

namespace tether::coordinator {

/// A request between its arrival and its reply.
struct PendingInteraction {
  link::Request request;
  record::Interaction entry;  ///< filled in as things happen
};

/// One SUT and the UAV that it flies. Plain state; `Coordinator` acts on it.
struct Session {
  std::size_t uav = 0;  ///< index in the world, and of the SUT in the barrier
  std::string uav_name;
  Duration command_latency{0};
  int cores = 0;  ///< of the SUT's machine; 0: not known
  /// Of each sensor, when the last image in the record was taken.
  std::vector<std::optional<SimTime>> recorded_image_at;

  // From joining to leaving.
  link::PeerId peer = 0;  ///< 0: nobody
  link::Hello hello;
  std::optional<sync::ExecutionTimer> timer;  ///< of an unstamped client
  std::optional<sync::ClockWitness> witness;  ///< tied, of one that stamps by its own clock
  std::uint64_t next_sequence = 1;
  SimTime called_at{};            ///< ST when the last request came
  std::size_t calls_in_step = 0;  ///< requests since ST came there
  AnnotationBudget annotations;
  std::optional<link::Finish> finish;
  bool left = false;  ///< finished or sent away: nothing more is expected or told

  /// Requests without their reply, in the order of their sequence: of a serial SUT one at most.
  std::vector<PendingInteraction> open;
  Duration last_hold{0};  ///< WT between the last request's arrival and its reply; 0: none yet

  bool joined() const { return peer != 0; }
  bool is_concurrent() const { return hello.concurrent; }
};

}  // namespace tether::coordinator
