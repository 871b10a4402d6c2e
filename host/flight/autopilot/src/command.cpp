#include "command.h"

#include "mount.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

namespace tether::autopilot {
namespace {

// Of COMMAND_INT [1e-7 degrees]; the largest integer stands for none.
double degrees_of(std::int64_t value) {
  return value == std::numeric_limits<std::int32_t>::max()
             ? std::numeric_limits<double>::quiet_NaN()
             : static_cast<double>(value) * 1e-7;
}

}  // namespace

std::int64_t whole(double value) {
  return value >= 0.0 && value < 1e9 ? std::llround(value) : -1;
}

bool is_place(double latitude_deg, double longitude_deg, double altitude_m) {
  constexpr double kMostAltitude_m = 1e5;
  return std::abs(latitude_deg) <= 90.0 && std::abs(longitude_deg) <= 180.0 &&
         std::abs(altitude_m) <= kMostAltitude_m;
}

bool is_command(const mavlink::Message& message) {
  return message.is("COMMAND_LONG") || message.is("COMMAND_INT");
}

Command to_command(const mavlink::Message& m) {
  Command command{.id = static_cast<int>(m.integer("command"))};
  for (std::size_t i = 1; i <= 4; ++i) command.p[i] = m.number("param" + std::to_string(i));
  if (m.is("COMMAND_INT")) {
    command.p[5] = degrees_of(m.integer("x"));
    command.p[6] = degrees_of(m.integer("y"));
    command.p[7] = m.number("z");
    if (command.id == kDoGimbalPitchYaw) command.p[5] = static_cast<double>(m.integer("x"));
    const auto mav_frame = m.integer("frame");
    command.is_place_relative = mav_frame == 3 || mav_frame == 6;
  } else {
    for (std::size_t i = 5; i <= 7; ++i) command.p[i] = m.number("param" + std::to_string(i));
  }
  return command;
}

mavlink::Message acknowledgement(const Command& command, int result, mavlink::Address to) {
  mavlink::Message message("COMMAND_ACK");
  message.set("command", command.id)
      .set("result", result)
      .set("target_system", to.system)
      .set("target_component", to.component);
  return message;
}

}  // namespace tether::autopilot
