#pragma once

#include "exact.h"

#include <algorithm>
#include <optional>
#include <string>

#include <tether/record/messages.h>

namespace tether::audit {

/// Rule 5: the largest growth of a SUT's ET in `elapsed` of the host's clock, with the tolerance of
/// two clocks; none if the SUT's clock is independent of the host's. The host measures a longer
/// time than the SUT, because of the link, never a shorter one.
/// - "wall": the same time plus 1 ms for the accuracy of readings.
/// - "cpu": the same time on each core, plus a tick of 10 ms for each core, at most 1 s: CPU time
/// of
///   other threads before the SUT resumed may be accounted later.
inline std::optional<Wide> granted(const record::SutInfo& sut, Wide elapsed) {
  constexpr Wide kClockDrift = 1000;        // one part in a thousand
  constexpr Wide kClockJitter = 1'000'000;  // 1 ms
  constexpr Wide kTick = 10'000'000;
  constexpr Wide kMostUnaccounted = 1'000'000'000;
  constexpr Wide kMostCores = 1024;  // if the number is unknown
  const Wide most = elapsed + (elapsed + kClockDrift - 1) / kClockDrift;
  if (sut.clock.kind == computer::ClockKind::kWall)
    return scaled(most + kClockJitter, sut.clock.factor);
  if (sut.clock.kind != computer::ClockKind::kCpu) return std::nullopt;
  const Wide cores = sut.cores > 0 ? Wide{sut.cores} : kMostCores;
  return scaled(cores * most + std::min(cores * kTick, kMostUnaccounted), sut.clock.factor);
}

/// The finding if ET grew by `grown` in `elapsed` of the host's clock; none if that is allowed.
inline std::optional<std::string> growth_fault(const record::SutInfo& sut, Wide grown,
                                               Wide elapsed) {
  const auto most = granted(sut, elapsed);
  if (!most || grown <= *most) return std::nullopt;
  return "ET grew by " + ns(grown) + " since the SUT resumed, in " + ns(elapsed) +
         " of the host's clock: " + ns(grown - *most) + " too much";
}

}  // namespace tether::audit
