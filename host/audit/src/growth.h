#pragma once

#include "exact.h"

#include <algorithm>
#include <optional>
#include <string>

#include <tether/record/messages.h>

namespace tether::audit {

/// Rule 5: the most ET of a SUT in `elapsed` on the host, within what two clocks may differ; none
/// where its clock says nothing of the host's. The host sees a SUT compute for longer than it did,
/// as the link adds to it, never for less.
/// - "wall": as much, and 1 ms, by which clocks may be misread.
/// - "cpu": as much on every core at once, and for each core a tick of 10 ms, but at most a second
///   in all: what other threads of the SUT computed before it went on may be accounted to it later.
inline std::optional<Wide> granted(const record::SutInfo& sut, Wide elapsed) {
  constexpr Wide kClockDrift = 1000;        // one part in a thousand
  constexpr Wide kClockJitter = 1'000'000;  // 1 ms
  constexpr Wide kTick = 10'000'000;
  constexpr Wide kMostUnaccounted = 1'000'000'000;
  constexpr Wide kMostCores = 1024;  // where nobody knows
  const Wide most = elapsed + (elapsed + kClockDrift - 1) / kClockDrift;
  if (sut.clock == "wall") return scaled(most + kClockJitter, sut.cpu_factor);
  if (sut.clock != "cpu") return std::nullopt;
  const Wide cores = sut.cores > 0 ? Wide{sut.cores} : kMostCores;
  return scaled(cores * most + std::min(cores * kTick, kMostUnaccounted), sut.cpu_factor);
}

/// What is wrong with `grown` of ET in `elapsed` on the host, if anything.
inline std::optional<std::string> growth_fault(const record::SutInfo& sut, Wide grown,
                                               Wide elapsed) {
  const auto most = granted(sut, elapsed);
  if (!most || grown <= *most) return std::nullopt;
  return "ET grew by " + ns(grown) + " since it last went on, while " + ns(elapsed) +
         " went by on the host: " + ns(grown - *most) + " too much";
}

}  // namespace tether::audit
