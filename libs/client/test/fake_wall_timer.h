#pragma once

#include "wall_timer.h"

#include <algorithm>

namespace tether::client {

/// A wall clock that moves only by sleeping and when told to.
class FakeWallTimer final : public WallTimer {
 public:
  Duration now() const override { return now_; }
  void sleep_until(Duration instant) override {
    slept_ += std::max(instant - now_, Duration::zero());
    now_ = std::max(now_, instant);
  }
  void advance(Duration duration) { now_ += duration; }
  Duration slept() const { return slept_; }

 private:
  Duration now_{1'000'000'000};
  Duration slept_{0};
};

}  // namespace tether::client
