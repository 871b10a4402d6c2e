#include "clocks.h"

#include <algorithm>
#include <cstdlib>

namespace tether::as_is {
namespace {

constexpr std::int64_t kNsPerSecond = 1'000'000'000;
constexpr std::int64_t kMost_s = 4'000'000'000;  // 127 years: also dates are within

std::int64_t epoch_s() {
  static const std::int64_t kEpoch = [] {
    const char* const text = std::getenv("TETHER_EPOCH");
    return text == nullptr ? kEpoch_s : std::strtoll(text, nullptr, 10);
  }();
  return kEpoch;
}

bool is_date(clockid_t clock) {
  return clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE || clock == CLOCK_TAI;
}

}  // namespace

bool is_ours(clockid_t clock) {
  return is_date(clock) || clock == CLOCK_MONOTONIC || clock == CLOCK_MONOTONIC_RAW ||
         clock == CLOCK_MONOTONIC_COARSE || clock == CLOCK_BOOTTIME;
}

Duration at_start(clockid_t clock) {
  return std::chrono::seconds(is_date(clock) ? epoch_s() : kUptime_s);
}

timespec to_timespec(Duration duration) {
  return {static_cast<time_t>(duration.count() / kNsPerSecond),
          static_cast<long>(duration.count() % kNsPerSecond)};
}

timespec shown(clockid_t clock, ExecTime et) {
  return to_timespec(at_start(clock) + et.time_since_epoch());
}

std::optional<Duration> duration_of(const timespec& time) {
  if (time.tv_sec < 0 || time.tv_nsec < 0 || time.tv_nsec >= kNsPerSecond) return std::nullopt;
  return std::chrono::seconds(std::min<std::int64_t>(time.tv_sec, kMost_s)) +
         Duration(time.tv_nsec);
}

ExecTime et_of(clockid_t clock, const timespec& time) {
  const std::int64_t begin_s = at_start(clock).count() / kNsPerSecond;
  const std::int64_t since_s = std::clamp<std::int64_t>(time.tv_sec - begin_s, -1, kMost_s);
  const Duration since = std::chrono::seconds(since_s) + Duration(time.tv_nsec);
  return ExecTime(std::max(since, Duration(0)));
}

}  // namespace tether::as_is
