#include "clocks/counted_source.h"

#include "clocks/descendants.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <thread>
#include <utility>

#include <tether/base/count_page.h>

namespace tether::client {
namespace {

// How long threads that start with the program may take until they wait.
constexpr std::chrono::milliseconds kSettleLimit{2000};
constexpr std::chrono::milliseconds kSettleStep{5};

Failure unusable(const std::string& why) {
  return {Failure::Kind::kInvalid,
          "the clock \"counted\" cannot be used: " + why +
              ". Start this program with `tether run` and a target file that has an 'emulator'"};
}

constexpr const char* kThreadsReason =
    "several threads of the program compute at the same time, so its count depends on their order. "
    "With the clock \"counted\", let one thread compute and the others wait (in OpenCV, "
    "cv::setNumThreads(1)), or use another clock";
constexpr const char* kProcessReason =
    "the program started a process, whose work is not counted. With the clock \"counted\", start "
    "processes before the program connects, and let them end; or use another clock";

constexpr const char* kClockReason =
    "the program asks for the machine's time again and again, so how much it computes depends on "
    "the machine. With the clock \"counted\", wait by the client library (sleep_for, sleep_until, "
    "a "
    "read with a timeout) and ask it for the time (now), or use another clock";

class CountedSource final : public TimeSource {
 public:
  explicit CountedSource(os::MappedCounts page) : page_(std::move(page)) {
    page_->watched.store(1);
  }
  ~CountedSource() override { page_->watched.store(0); }
  CountedSource(const CountedSource&) = delete;
  CountedSource& operator=(const CountedSource&) = delete;

  computer::Clock clock() const override { return {computer::ClockKind::kCounted}; }

  Duration elapsed() const override { return before_ + since_resume(page_->units.load()); }

  void hold() const override { page_->held.store(1); }

  // Costs have fractions of nanoseconds. A span begins with a whole one, so that its length does
  // not depend on what was counted before.
  Duration elapsed_at_resume() const override {
    page_->held.store(0);
    const std::uint64_t total = page_->units.load();
    before_ += since_resume(total);
    resumed_at_units_ = total;
    return before_;
  }

  Status complete() const override {
    // No program can do without work between two readings, not even this library.
    if (page_->units.load() == resumed_at_units_)
      return unusable("its page of counts does not advance while the program computes");
    switch (static_cast<CountFault>(page_->fault.load())) {
      case CountFault::kNone:
        return ok_status();
      case CountFault::kThreads:
        return Failure{Failure::Kind::kRefused, kThreadsReason};
      case CountFault::kProcess:
        return Failure{Failure::Kind::kRefused, kProcessReason};
      case CountFault::kClock:
        return Failure{Failure::Kind::kRefused, kClockReason};
    }
    return unusable("its page has the unknown fault " + std::to_string(page_->fault.load()));
  }

 private:
  Duration since_resume(std::uint64_t total_units) const {
    return Duration(static_cast<std::int64_t>((total_units - resumed_at_units_) /
                                              static_cast<std::uint64_t>(kCostUnitsPerNs)));
  }

  os::MappedCounts page_;
  mutable Duration before_{0};
  mutable std::uint64_t resumed_at_units_ = page_->units.load();
};

/// A program that an emulated program started may run without the emulator.
bool is_counted(const CountPage& page) {
  const std::uint64_t before = page.units.load();
  volatile int steps = 0;
  while (steps < 1000) steps = steps + 1;
  const std::uint64_t least =
      500 * *std::min_element(page.cost_units.begin(), page.cost_units.end());
  return page.units.load() - before >= least && least > 0;
}

bool settles(const CountPage& page) {
  const auto end = std::chrono::steady_clock::now() + kSettleLimit;
  while (page.computing.load() > 1) {
    if (std::chrono::steady_clock::now() >= end) return false;
    std::this_thread::sleep_for(kSettleStep);
  }
  return true;
}

Status check(const CountPage& page, const std::string& file) {
  if (page.magic != CountPage::kMagic || page.version != CountPage::kVersion ||
      page.classes != kWorkClasses)
    return unusable(file + " is not a page of counts of this version of Tether");
  if (page.plugin_version.load() != CountPage::kVersion)
    return unusable("no plugin of this version of Tether counts in " + file);
  if (!is_counted(page)) return unusable("the counts in " + file + " do not advance");
  if (has_children()) return Failure{Failure::Kind::kRefused, kProcessReason};
  if (!settles(page)) return Failure{Failure::Kind::kRefused, kThreadsReason};
  return ok_status();
}

}  // namespace

std::unique_ptr<TimeSource> source_of(os::MappedCounts page) {
  return std::make_unique<CountedSource>(std::move(page));
}

Result<std::unique_ptr<TimeSource>> make_counted_source(const std::string& file) {
  if (file.empty()) return unusable("TETHER_COUNTS is not set");
  os::MappedCounts page = os::map_counts(file);
  if (!page) return unusable("TETHER_COUNTS is " + file + ", which cannot be mapped");
  if (const Status good = check(*page, file); !good) return good.failure();
  return source_of(std::move(page));
}

}  // namespace tether::client
