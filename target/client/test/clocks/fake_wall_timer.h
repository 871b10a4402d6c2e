#pragma once

#include "clocks/wall_timer.h"

#include <atomic>
#include <cstdint>
#include <functional>
#include <utility>

namespace tether::client {

/// A wall clock that moves only by sleeping and when told to. One thread moves it; others may read.
class FakeWallTimer final : public WallTimer {
 public:
  Duration now() const override { return Duration(now_ns_.load()); }
  void sleep_until(Duration instant) override {
    if (instant <= now()) return;
    if (during_sleep_) during_sleep_();
    slept_ += instant - now();
    now_ns_ = instant.count();
  }
  void advance(Duration duration) { now_ns_ += duration.count(); }
  Duration slept() const { return slept_; }
  /// What happens at the beginning of each sleep that is none of zero length.
  void during_sleep(std::function<void()> action) { during_sleep_ = std::move(action); }

 private:
  std::atomic<std::int64_t> now_ns_{1'000'000'000};
  Duration slept_{0};
  std::function<void()> during_sleep_;
};

}  // namespace tether::client
