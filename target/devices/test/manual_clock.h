#pragma once

#include "clock.h"

#include <algorithm>

namespace tether::devices {

/// Advances only by `advance` and by sleeping.
class ManualClock final : public Clock {
 public:
  Duration now() const override { return now_; }
  void sleep_until(Duration instant) override { now_ = std::max(now_, instant); }
  void advance(Duration duration) { now_ += duration; }

 private:
  Duration now_ = std::chrono::hours(5);  // since the machine was started
};

}  // namespace tether::devices
