#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <tether/base/time.h>
#include <tether/uav/setpoint.h>

namespace tether::coordinator {

/// A command and the step boundary at which it takes effect.
struct PendingCommand {
  SimTime effect_at;
  std::size_t uav = 0;
  std::uint64_t sequence = 0;
  uav::VelocityCommand command;
};

/// Commands in the order of their effect; those of one boundary in the order of
/// UAVs, and for each UAV in the order of arrival.
class CommandQueue {
 public:
  void push(const PendingCommand& command);
  /// Commands of this UAV that are not in effect yet.
  std::size_t waiting(std::size_t uav) const;
  /// The boundary of the next effect; SimTime::max() if the queue is empty.
  SimTime next_effect() const;
  /// Removes and returns the first command whose effect is at or before `st`.
  std::optional<PendingCommand> pop_due(SimTime st);

 private:
  std::vector<PendingCommand> commands_;  // the last takes effect first
  std::vector<std::size_t> waiting_;      // of each UAV
};

}  // namespace tether::coordinator
