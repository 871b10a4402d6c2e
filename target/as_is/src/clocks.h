#pragma once

#include <optional>

#include <time.h>

#include <tether/base/time.h>

namespace tether::as_is {

/// The date at which a run begins, unless TETHER_EPOCH has another one [s since 1970]: the first of
/// January 2026.
inline constexpr std::int64_t kEpoch_s = 1'767'225'600;
/// How long the machine has been on then.
inline constexpr std::int64_t kUptime_s = 1'000;

/// Whether it is a clock of which the program sees ET.
bool is_ours(clockid_t clock);
/// What it shows at ET 0. @pre is_ours(clock)
Duration at_start(clockid_t clock);
/// What it shows then.
timespec shown(clockid_t clock, ExecTime et);
/// The ET at which it shows that; from before ET 0, ET 0. @pre is_ours(clock)
ExecTime et_of(clockid_t clock, const timespec& time);
/// A duration, within what ET can have; none: it is no duration.
std::optional<Duration> duration_of(const timespec& time);
timespec to_timespec(Duration duration);

}  // namespace tether::as_is
