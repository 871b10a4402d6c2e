#pragma once

#include "radio_traffic.h"
#include "run_log.h"
#include "sessions/validator.h"
#include "stepper.h"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <tether/autopilot/flight_controller.h>
#include <tether/coordinator/coordinator.h>
#include <tether/radio/medium.h>
#include <tether/sync/least_tree.h>

namespace tether::coordinator {

/// One direction of a serial line: messages in order, of which each byte takes its time (a start
/// bit, eight bits and a stop bit), and then the latency. Pure.
class Line {
 public:
  Line(double baud, Duration latency) : baud_(baud), latency_(latency) {}
  /// When a message arrives that was sent at `at`; none: there is no room for it in the sender's
  /// buffer, which has a second's worth of bytes, or too much was sent since the second of ST
  /// began. @pre not before an earlier message
  std::optional<SimTime> send(SimTime at, std::size_t bytes);

 private:
  double baud_;  // 0: bytes take no time
  Duration latency_;
  SimTime free_at_{};
  SecondOfSending second_;
};

/// The flight controllers and their links to the SUTs, their companions (DESIGN section 2, "Flight
/// controllers"). A controller steps at the multiples of its period, one nanosecond after the
/// boundary: it has all that its companion sent up to there, and what it sends arrives later. Its
/// messages are received as those by radio, from `link::kAutopilot`. Not thread-safe.
class ControllerLinks {
 public:
  /// Makes the controllers, which boot. `log` must outlive this.
  ControllerLinks(const RunOptions& options, std::vector<std::string> uavs, Stepper& stepper,
                  RunLog& log);

  bool has(std::size_t uav) const { return ports_[uav].controller != nullptr; }
  /// Of the controller's program. @pre has(uav)
  std::string version(std::size_t uav) const { return ports_[uav].controller->version(); }
  /// The companion sends a message. @pre has(uav); in the order of time
  void send(std::size_t uav, std::uint64_t sequence, SimTime at,
            const std::vector<std::uint8_t>& bytes);

  /// The next step of a controller, or arrival at a companion. None: there is no controller.
  std::optional<sync::SutTime> next() const;
  /// Handles it. @throws SimulatorFailure if the controller, a part of the vehicle, is lost.
  /// Returns the UAV whose companion has got a message, and when. @pre next(), and ST is at its
  /// boundary
  struct Arrival {
    std::size_t uav = 0;
    SimTime at;
  };
  std::optional<Arrival> handle_next(Stepper& stepper, RadioTraffic& inboxes);

  /// Records what is on its way at the end of the run.
  void log_in_transit(SimTime st, const StepGrid& grid);

 private:
  struct Message {
    std::uint64_t sequence = 0;
    SimTime sent_at;
    SimTime arrives_at;
    std::shared_ptr<const std::vector<std::uint8_t>> bytes;
    bool is_lost = false;  // there was no room for it
  };
  struct Port {
    std::unique_ptr<autopilot::FlightController> controller;
    Duration period{0};
    std::int64_t steps = 0;
    std::uint64_t sent = 0, of_station = 0;
    Line to_controller{0.0, Duration(0)}, to_companion{0.0, Duration(0)};
    std::deque<Message> for_controller, for_companion;

    SimTime next_step() const { return SimTime(steps * period); }
  };
  void step(std::size_t uav, Stepper& stepper);
  void schedule(std::size_t uav);
  enum class Direction { kTo, kFrom, kOfStation };
  /// What a step has received.
  void log_taken(SimTime at, std::size_t uav, const std::vector<Message>& taken,
                 const std::vector<autopilot::Actions::Refusal>& refused);
  void log(SimTime st, std::size_t uav, Direction direction, const Message& message,
           std::string_view outcome, std::optional<SimTime> acted_at = std::nullopt);

  std::vector<std::string> uavs_;
  std::vector<Port> ports_;   // by UAV
  sync::LeastTree steps_;     // of each controller
  sync::LeastTree arrivals_;  // of the next message of each companion
  RunLog* log_;
};

}  // namespace tether::coordinator
