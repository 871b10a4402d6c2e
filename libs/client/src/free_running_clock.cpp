#include "free_running_clock.h"

#include <cmath>

namespace tether::client {

FreeRunningClock::FreeRunningClock(const TimeSource& source, WallTimer& wall, ExecTime start)
    : source_(&source),
      wall_(&wall),
      start_(start),
      wall_at_start_(wall.now()),
      accounted_(source.elapsed()) {}

ExecTime FreeRunningClock::now() const {
  return start_ + (wall_->now() - wall_at_start_);
}

ExecTime FreeRunningClock::begin() {
  if (source_->factor() > 1.0) {
    // Of the target's time, 1/factor has gone by here already.
    const Duration on_target = source_->elapsed() - accounted_;
    const double missing = 1.0 - 1.0 / source_->factor();
    const Duration stall(std::llround(static_cast<double>(on_target.count()) * missing));
    wall_->sleep_until(wall_->now() + stall);
  }
  accounted_ = source_->elapsed();
  return now();
}

void FreeRunningClock::end(ExecTime) {
  accounted_ = source_->elapsed();
}

void FreeRunningClock::sleep_until(ExecTime until) {
  begin();
  wall_->sleep_until(wall_at_start_ + (until - start_));
  end(until);
}

}  // namespace tether::client
