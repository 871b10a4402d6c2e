#pragma once

#include <cstdint>
#include <string_view>

namespace tether::client {

/// What tether-exec tells a process of a program that knows nothing of Tether: a Reply whose
/// sequence is one of these, on a connection of its own. The process answers each with a Progress.
/// In its Hello, the program is named so.
inline constexpr std::string_view kGroupEvents = "tether-events";
enum class GroupEvent : std::uint64_t {
  kDue = 1,   ///< a deadline or a timer of it is over
  kMeasured,  ///< a sensor that wakes it has measured
  kMessage    ///< of the flight controller; the Reply has it
};

}  // namespace tether::client
