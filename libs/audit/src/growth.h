#pragma once

#include "exact.h"

#include <optional>
#include <string>

#include <tether/record/messages.h>

namespace tether::audit {

/// Rule 5: ET by a wall clock grows no faster than the host's (times the clock's factor), within
/// what two clocks may differ; CPU time no faster than on all cores of the largest machine at once.
/// The host sees a SUT compute for longer than it did, as the link adds to it, never for less. What
/// is wrong with `grown` of ET in `elapsed` on the host, if anything.
inline std::optional<std::string> growth_fault(const record::SutInfo& sut, Wide grown,
                                               Wide elapsed) {
  constexpr Wide kClockDrift = 1000;        // one part in a thousand …
  constexpr Wide kClockJitter = 1'000'000;  // … and 1 ms
  constexpr Wide kMostCores = 1024;
  const Wide most = elapsed + elapsed / kClockDrift + kClockJitter;
  if (sut.clock != "wall" && sut.clock != "cpu") return std::nullopt;
  const Wide granted = scaled(sut.clock == "cpu" ? kMostCores * most : most, sut.cpu_factor);
  if (grown <= granted) return std::nullopt;
  return "ET grew by " + ns(grown) + " since it last went on, while " + ns(elapsed) +
         " went by on the host: " + ns(grown - granted) + " too much";
}

}  // namespace tether::audit
