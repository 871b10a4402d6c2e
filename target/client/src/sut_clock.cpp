#include <tether/client/sut_clock.h>

namespace tether::client {

SutClock::SutClock(const TimeSource& source, ExecTime start)
    : source_(&source), base_et_(start), base_source_(source.elapsed()) {}

ExecTime SutClock::now() const {
  return held_ ? base_et_ : base_et_ + (source_->elapsed() - base_source_);
}

ExecTime SutClock::hold() {
  base_et_ = now();
  held_ = true;
  return base_et_;
}

void SutClock::resume(ExecTime at) {
  base_et_ = at;
  base_source_ = source_->elapsed();
  held_ = false;
}

}  // namespace tether::client
