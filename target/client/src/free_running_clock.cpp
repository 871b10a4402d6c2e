#include "free_running_clock.h"

#include <algorithm>

namespace tether::client {

namespace {
// The longest sleep; sums with the wall clock stay within
// int64.
constexpr Duration kLongestSleep = std::chrono::hours(24 * 365);
}  // namespace

FreeRunningClock::FreeRunningClock(const TimeSource& source, WallTimer& wall, ExecTime start)
    : source_(&source),
      wall_(&wall),
      start_(start),
      wall_at_start_(wall.now()),
      computing_since_(wall_at_start_),
      accounted_(source.elapsed()) {}

ExecTime FreeRunningClock::now() const {
  const std::lock_guard lock(mutex_);
  return et_at(wall_of_target());
}

std::optional<ExecTime> FreeRunningClock::while_computing() const {
  const std::lock_guard lock(mutex_);
  if (phase_ == Phase::kCall) return std::nullopt;
  return et_at(wall_of_target());
}

// Where the target's wall clock would be. With the mutex held.
Duration FreeRunningClock::wall_of_target() const {
  const Duration here = wall_->now();
  if (phase_ == Phase::kStalling) return std::max(here, stall_until_);
  if (phase_ != Phase::kComputing || source_->factor() <= 1.0) return here;
  return std::max(here, computing_since_ + (source_->elapsed() - accounted_));
}

ExecTime FreeRunningClock::begin() {
  Duration stall_until{};
  {
    const std::lock_guard lock(mutex_);
    if (phase_ != Phase::kComputing) return et_at(wall_of_target());
    stall_until = stall_until_ = wall_of_target();
    phase_ = Phase::kStalling;
  }
  wall_->sleep_until(stall_until);
  enter(Phase::kCall);
  return now();
}

void FreeRunningClock::end(ExecTime) {
  const std::lock_guard lock(mutex_);
  computing_since_ = wall_->now();
  accounted_ = source_->elapsed();
  phase_ = Phase::kComputing;
}

void FreeRunningClock::sleep_until(ExecTime until) {
  begin();
  enter(Phase::kSleeping);
  wall_->sleep_until(wall_at_start_ + std::min(until - start_, kLongestSleep));
  end(until);
}

void FreeRunningClock::enter(Phase phase) {
  const std::lock_guard lock(mutex_);
  phase_ = phase;
}

}  // namespace tether::client
