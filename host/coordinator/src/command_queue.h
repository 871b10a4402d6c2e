#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <tether/base/time.h>
#include <tether/uav/samples.h>

namespace tether::coordinator {

/// A command on its way to the step boundary on which it acts.
struct PendingCommand {
  SimTime effect_at;
  std::size_t uav = 0;
  std::uint64_t sequence = 0;
  uav::VelocityCommand command;
};

/// Commands in the order of their effect, those of one boundary in the order of their arrival.
class CommandQueue {
 public:
  void push(const PendingCommand& command);
  /// How many of this UAV have not acted yet.
  std::size_t waiting(std::size_t uav) const;
  /// The next boundary on which one acts; SimTime::max() if none waits.
  SimTime next_effect() const;
  /// Takes the first command that acts at or before `st`.
  std::optional<PendingCommand> pop_due(SimTime st);

 private:
  std::vector<PendingCommand> commands_;  // last acts first
  std::vector<std::size_t> waiting_;      // of each UAV
};

}  // namespace tether::coordinator
