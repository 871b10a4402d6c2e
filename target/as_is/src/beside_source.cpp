#include "beside_source.h"

#include "threads.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>
#include <utility>

namespace tether::as_is {
namespace {

// SutClock reads it from the thread that calls: at the hold, and once more at the resume.
class BesideSource final : public client::TimeSource {
 public:
  explicit BesideSource(std::unique_ptr<client::TimeSource> source)
      : source_(std::move(source)), factor_(source_->clock().factor) {}

  computer::Clock clock() const override { return source_->clock(); }
  Duration elapsed() const override { return last_ = source_->elapsed(); }
  Duration elapsed_at_resume() const override { return last_ = source_->elapsed_at_resume(); }
  void hold() const override { is_held_ = true; }  // the source need not measure it, too
  Duration elapsed_in_children() const override {
    if (!is_held_) is_beside_ = Threads::are_several();
    const Duration own = source_->counted_of_thread();
    const Duration others =
        is_beside_
            ? last_.load() - Duration(std::llround(static_cast<double>(own.count()) * factor_))
            : source_->elapsed_in_children();
    if (!std::exchange(is_held_, false)) at_hold_ = others;
    return std::max(others, at_hold_);
  }
  Status complete() const override { return source_->complete(); }
  void leave_out(Duration computed) override { source_->leave_out(computed); }
  Duration counted_of_thread() const override { return source_->counted_of_thread(); }
  void exclude_calling_thread() override { source_->exclude_calling_thread(); }
  void release_calling_thread() override { source_->release_calling_thread(); }

 private:
  std::unique_ptr<client::TimeSource> source_;
  double factor_;
  mutable std::atomic<Duration> last_{Duration(0)};
  // Guarded by SutClock's user:
  mutable bool is_held_ = false, is_beside_ = false;  // now; at the hold
  mutable Duration at_hold_{0};
};

std::atomic<Duration> g_beside_calls{Duration(0)};

// The same of a wall clock, for which nothing is charged: it is only known.
class WatchedSource final : public client::TimeSource {
 public:
  explicit WatchedSource(std::unique_ptr<client::TimeSource> source) : source_(std::move(source)) {}

  computer::Clock clock() const override { return source_->clock(); }
  Duration elapsed() const override { return source_->elapsed(); }
  void hold() const override { at_hold_ = client::cpu_time_of_other_threads(); }
  Duration elapsed_at_resume() const override {
    if (const auto since = std::exchange(at_hold_, std::nullopt))
      g_beside_calls = g_beside_calls.load() +
                       std::max(Duration(0), client::cpu_time_of_other_threads() - *since);
    return source_->elapsed_at_resume();
  }

 private:
  std::unique_ptr<client::TimeSource> source_;
  mutable std::optional<Duration> at_hold_;  // guarded by SutClock's user
};

}  // namespace

Duration computed_beside_calls() {
  return g_beside_calls;
}

std::unique_ptr<client::TimeSource> charge_beside_calls(
    std::unique_ptr<client::TimeSource> source) {
  if (source->clock().kind == computer::ClockKind::kWall)
    return std::make_unique<WatchedSource>(std::move(source));
  if (source->clock().kind != computer::ClockKind::kCpu) return source;
  return std::make_unique<BesideSource>(std::move(source));
}

}  // namespace tether::as_is
