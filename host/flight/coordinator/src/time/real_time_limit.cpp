#include "time/real_time_limit.h"

#include <algorithm>
#include <cmath>

namespace tether::coordinator {

RealTimeLimit::RealTimeLimit(double factor, Duration max_credit, WallTime now)
    : factor_(factor), max_credit_(max_credit), last_(now) {}

Duration RealTimeLimit::allowance(WallTime now) {
  const double earned_ns = static_cast<double>((now - last_).count()) * factor_;
  credit_ = std::min(max_credit_, credit_ + Duration(std::llround(earned_ns)));
  last_ = now;
  return credit_;
}

void RealTimeLimit::idle(WallTime now) {
  last_ = now;
  credit_ = Duration(0);
}

Duration RealTimeLimit::wait_for(Duration wanted) const {
  const Duration missing = wanted - credit_;
  if (missing <= Duration(0)) return Duration(0);
  return Duration(std::llround(std::ceil(static_cast<double>(missing.count()) / factor_)));
}

}  // namespace tether::coordinator
