#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tether/judge/judge.h>

namespace tether::judge {

/// Of the mission's tasks that ran, from the annotations of the topic "mission"; others do not
/// count. A task that is repeated has one span. Texts of the SUT become one printable line.
std::vector<TaskSpan> task_spans(const mission::Mission& mission, const std::string& uav,
                                 const record::Record& record);

struct Span {
  SimTime from, to;
};
/// From the start of the run to the end of the mission: the SUT's finish, or the end of the run.
Span mission_span(const std::string& uav, const record::Record& record);

/// What took the time of a span, most first: "computing 12.1 s, waiting for camera 6.3 s". Of a
/// concurrent SUT, whose calls overlap, empty.
std::string time_taken(const std::string& uav, const Span& span, const record::Record& record);

}  // namespace tether::judge
