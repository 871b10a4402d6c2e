#include <tether/client/sut_clock.h>

namespace tether::client {

SutClock::SutClock(const TimeSource& source, ExecTime start)
    : source_(&source), base_et_(start), base_source_(source.elapsed_at_resume()) {}

ExecTime SutClock::now() const {
  return held_ ? base_et_ : base_et_ + (source_->elapsed() - base_source_);
}

ExecTime SutClock::hold() {
  if (held_) return base_et_;
  base_et_ = now();
  children_at_hold_ = source_->elapsed_in_children();
  held_ = true;
  source_->hold();
  return base_et_;
}

void SutClock::resume(ExecTime at) {
  base_et_ = at;
  const Duration elapsed = source_->elapsed_at_resume();
  base_source_ = elapsed - (source_->elapsed_in_children() - children_at_hold_);
  held_ = false;
}

}  // namespace tether::client
