#pragma once

#include "missions.h"
#include "outbox.h"
#include "vehicle.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include <tether/autopilot/flight_controller.h>
#include <tether/uav/setpoint.h>

namespace tether::autopilot {

/// What a message of telemetry is made of.
struct TelemetrySource {
  const Vehicle& vehicle;
  const Sensed& sensed;
  const uav::Setpoint& setpoint;  // what the vehicle follows
  const Missions& missions;
};

/// A message that can be sent regularly, and how often it is at first.
struct StreamRate {
  std::string_view name;
  double rate_hz = 0.0;  ///< 0: only on request
};
std::vector<StreamRate> stream_rates();

/// The streams: which messages are sent how often.
class Telemetry {
 public:
  /// On a line of so many baud; 0: any. All streams but HEARTBEAT are slowed down by one factor so
  /// that they take half of it, but to a twentieth at most (docs.px4.io, "MAVLink Messaging").
  explicit Telemetry(double link_baud = 0.0);

  /// What is due at this step.
  void step(const TelemetrySource& source, Outbox& outbox);
  /// Sends it once, at the next step. False: it is no stream.
  bool request(std::string_view name);
  /// As MAV_CMD_SET_MESSAGE_INTERVAL: −1: never, 0: as at first. False: it is no stream.
  bool set_interval(std::string_view name, double interval_us);
  bool tell_interval(const mavlink::MessageType& type, Outbox& outbox) const;

 private:
  struct Stream {
    const mavlink::MessageType* type;
    std::optional<Duration> interval;  // as it was asked for; none: only on request
    Duration slowed{};                 // as the line has room for it
    SimTime next{};
    bool is_requested = false;
  };
  /// After a change of intervals: slows them down.
  void fit_line();

  double most_B_s_;              // 0: any
  std::vector<Stream> streams_;  // in the order of the table
};

}  // namespace tether::autopilot
