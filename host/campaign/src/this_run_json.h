#pragma once

#include "json_reader.h"

#include <chrono>

#include <tether/campaign/result.h>

/// The member "this_run" of `result.json`, and the exact seconds that all of the file has.
namespace tether::campaign {

// Division rounds correctly, so that every nanosecond count prints short and reads back exactly.
inline double exact_seconds(Duration d) {
  return static_cast<double>(d.count()) / 1e9;
}
template <class Clock>
double exact_seconds(std::chrono::time_point<Clock, Duration> t) {
  return exact_seconds(t.time_since_epoch());
}

Json json_of(const ThisRun& run);
/// @throws Error(kBadFile) about the member that is wrong.
ThisRun read_this_run(const JsonReader& json);

}  // namespace tether::campaign
