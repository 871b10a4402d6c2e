#pragma once

#include "spans.h"

#include <string>
#include <vector>

#include <tether/mission/condition.h>

namespace tether::judge {

/// One value of an event quantity (mission::Quantity::is_event).
struct Event {
  SimTime at;           ///< when it was known
  double value = 0.0;   ///< [s]
  std::string parts{};  ///< of a reaction time: what it consists of
};

/// The events of a span: those whose data, too, was had in it.
std::vector<Event> events_of(const mission::Condition& condition, const std::string& uav,
                             const Span& span, const record::Record& record);

}  // namespace tether::judge
