#pragma once

#include <cstdint>

#include <tether/mavlink/frame.h>

namespace tether::autopilot {

// MAV_COMPONENT.
inline constexpr std::uint8_t kAutopilot = 1, kGimbal = 154;

/// MAV_RESULT.
namespace command_result {
inline constexpr int kAccepted = 0, kRejected = 1, kDenied = 2, kUnsupported = 3, kFailed = 4;
}

/// A command, from COMMAND_LONG or COMMAND_INT. `p`: its parameters 1 to 7, of which 5 and 6 are in
/// degrees or metres.
struct Command {
  int id = 0;
  double p[8] = {};
  bool is_place_relative = false;  ///< its altitude is over home
};

/// Whether a UAV can be asked to fly there. False also if one of them is no number.
bool is_place(double latitude_deg, double longitude_deg, double altitude_m);

bool is_command(const mavlink::Message& message);
/// @pre is_command(message)
Command to_command(const mavlink::Message& message);
/// COMMAND_ACK, to who has sent the command.
mavlink::Message acknowledgement(const Command& command, int result, mavlink::Address to);

/// A whole number; −1: it is none, or negative.
std::int64_t whole(double value);

}  // namespace tether::autopilot
