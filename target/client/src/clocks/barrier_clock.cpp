#include "clocks/barrier_clock.h"

namespace tether::client {

ExecTime BarrierClock::now() const {
  const std::lock_guard lock(mutex_);
  return clock_.now();
}

ExecTime BarrierClock::begin() {
  const std::lock_guard lock(mutex_);
  return clock_.hold();
}

void BarrierClock::end(ExecTime at) {
  const std::lock_guard lock(mutex_);
  clock_.resume(at);
}

std::optional<ExecTime> BarrierClock::while_computing() const {
  const std::lock_guard lock(mutex_);
  if (clock_.is_held()) return std::nullopt;
  return clock_.now();
}

}  // namespace tether::client
