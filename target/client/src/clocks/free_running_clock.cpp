#include "clocks/free_running_clock.h"

#include <algorithm>
#include <cmath>

namespace tether::client {

FreeRunningClock::FreeRunningClock(const TimeSource& source, WallTimer& wall, ExecTime start,
                                   double real_time_factor)
    : source_(&source),
      wall_(&wall),
      real_time_factor_(real_time_factor),
      st_at_reply_(start),
      wall_at_reply_(wall.now()),
      latest_(start),
      computing_since_(wall_at_reply_),
      accounted_(source.elapsed()) {}

ExecTime FreeRunningClock::now() const {
  const std::lock_guard lock(mutex_);
  return read();
}

std::optional<ExecTime> FreeRunningClock::while_computing() const {
  const std::lock_guard lock(mutex_);
  if (phase_ == Phase::kCall) return std::nullopt;
  return read();
}

// With the mutex held, also below.
ExecTime FreeRunningClock::read() const {
  const auto passed_ns = static_cast<double>((wall_of_target() - wall_at_reply_).count());
  const Duration passed(std::llround(passed_ns * real_time_factor_));
  latest_ = std::max(latest_, st_at_reply_ + passed);
  return latest_;
}

// Where the target's wall clock would be.
Duration FreeRunningClock::wall_of_target() const {
  const Duration here = wall_->now();
  if (phase_ == Phase::kStalling) return std::max(here, stall_until_);
  if (phase_ != Phase::kComputing || source_->clock().factor <= 1.0) return here;
  return std::max(here, computing_since_ + (source_->elapsed() - accounted_));
}

ExecTime FreeRunningClock::begin() {
  Duration stall_until{};
  {
    const std::lock_guard lock(mutex_);
    if (phase_ == Phase::kCall) return stamp_;
    stall_until = stall_until_ = wall_of_target();
    phase_ = Phase::kStalling;
  }
  wall_->sleep_until(stall_until);
  const std::lock_guard lock(mutex_);
  phase_ = Phase::kCall;
  stamp_ = read();
  return stamp_;
}

void FreeRunningClock::end(ExecTime at) {
  const std::lock_guard lock(mutex_);
  st_at_reply_ = at;
  wall_at_reply_ = computing_since_ = wall_->now();
  accounted_ = source_->elapsed();
  phase_ = Phase::kComputing;
}

}  // namespace tether::client
