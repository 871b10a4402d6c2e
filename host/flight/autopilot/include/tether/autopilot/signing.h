#pragma once

#include <memory>
#include <string>
#include <string_view>

#include <tether/autopilot/flight_controller.h>

namespace tether::autopilot {

/// What is wrong with the content of a file with a key for signatures of MAVLink 2: it has 32
/// bytes, or 64 hexadecimal digits. Empty: nothing.
std::string complaint_about_signing_key(std::string_view content);

/// The same controller, whose link to the companion is signed with that key, both ways: what is not
/// signed, wrongly, or comes again is refused. Its clock begins on 2026-01-01, as that of programs
/// as they are. @pre the key is right
std::unique_ptr<FlightController> with_signing(std::unique_ptr<FlightController> controller,
                                               std::string_view key);

}  // namespace tether::autopilot
