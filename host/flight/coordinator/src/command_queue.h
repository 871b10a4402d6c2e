#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <tether/base/time.h>
#include <tether/sync/least_tree.h>
#include <tether/uav/setpoint.h>

namespace tether::coordinator {

/// A command on its way to the flight controller.
struct PendingCommand {
  SimTime arrives_at;  ///< exact; takes effect at the first step boundary from there on
  std::size_t uav = 0;
  std::uint64_t sequence = 0;
  std::vector<uav::TimedSetpoint> setpoints;  ///< not empty
};

/// What a UAV follows from a boundary on.
struct CommandEffect {
  std::size_t uav = 0;
  std::uint64_t sequence = 0;  ///< of the command, which was the last one if the link is lost
  std::size_t index = 0;       ///< of the set-point in the command
  uav::Setpoint setpoint;      ///< of a loss: the last one
  std::optional<uav::LossAction> loss{};
};

/// The flight controllers' side of commands. Set-points in the order of their effect; those of one
/// boundary in the order of UAVs, and for each UAV of their exact time. A command ends the
/// trajectory before it. If no command has arrived for longer than a UAV's timeout since its last
/// set-point, the link is lost.
class CommandQueue {
 public:
  /// `losses`: of each UAV.
  CommandQueue(StepGrid grid, const std::vector<std::optional<uav::SetpointLoss>>& losses);

  /// Commands of a UAV arrive in the order in which they were given: one that would overtake
  /// another arrives with it. Returns when this one arrives.
  SimTime push(PendingCommand command);
  /// Set-points of this UAV that are not in effect yet.
  std::size_t waiting(std::size_t uav) const { return flights_[uav].waiting; }
  /// The boundary of the next effect; SimTime::max() if there is none.
  SimTime next_effect() const;
  /// Removes and returns the first effect that is due at or before `st`.
  std::optional<CommandEffect> pop_due(SimTime st);

 private:
  struct Flight {
    std::optional<uav::SetpointLoss> loss{};
    SimTime last_arrival{};
    std::size_t waiting = 0;
    std::optional<PendingCommand> flown{};  ///< its command in effect
    std::size_t next = 0;                   ///< of its set-points; as many as there are: the loss
  };

  bool has_due(const Flight& flight) const;
  SimTime time_of_next(const Flight& flight) const;
  void schedule(std::size_t uav);
  CommandEffect take_next(std::size_t uav);
  bool precedes(const PendingCommand& command, std::size_t running) const;

  StepGrid grid_;
  std::vector<PendingCommand> commands_;  // that have not arrived; the last arrives first
  std::vector<Flight> flights_;           // by UAV
  sync::LeastTree next_;                  // boundary of the next effect of each `flown`
};

}  // namespace tether::coordinator
