#pragma once

#include <atomic>
#include <cstdint>
#include <memory>

#include <tether/client/sut_clock.h>

namespace tether::client_testing {

/// A time source that moves only when told to. Copies move together, so that a test keeps one and
/// gives the other away. Thread-safe.
class ManualTimeSource final : public client::TimeSource {
 public:
  /// A kind other than scripted lets a vehicle report progress.
  explicit ManualTimeSource(computer::ClockKind kind = computer::ClockKind::kScripted,
                            double factor = 1.0);

  computer::Clock clock() const override { return clock_; }
  Duration elapsed() const override { return Duration(elapsed_ns_->load()); }

  Duration elapsed_in_children() const override { return Duration(children_ns_->load()); }

  /// The SUT computes for `duration` [ET]. @pre duration ≥ 0
  void advance(Duration duration) { *elapsed_ns_ += duration.count(); }
  /// The same, by its children.
  void advance_children(Duration duration) {
    *children_ns_ += duration.count();
    advance(duration);
  }

 private:
  computer::Clock clock_;
  std::shared_ptr<std::atomic<std::int64_t>> elapsed_ns_, children_ns_;  // shared by the copies
};

}  // namespace tether::client_testing
