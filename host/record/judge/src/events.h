#pragma once

#include "spans.h"

#include <optional>
#include <string>
#include <vector>

#include <tether/mission/mission.h>

namespace tether::judge {

/// What a reaction time, or the age of data, consists of.
struct Reaction {
  Duration until_had;      ///< from the measurement's instant until the program had it
  Duration until_command;  ///< from then to its command
  Duration until_effect;   ///< from then to the effect; of an age, 0
  Duration computing;      ///< of `until_command`: without the waits of other calls
};

/// One value of an event quantity (mission::Quantity::is_event).
struct Event {
  SimTime at;          ///< when it was known
  double value = 0.0;  ///< [s]
  std::optional<Reaction> reaction{};
};

/// The events of a span: those whose data, too, was had in it.
std::vector<Event> events_of(const mission::Condition& condition, const std::string& uav,
                             const Span& span, const record::Record& record);

}  // namespace tether::judge
