#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <optional>

#include <pthread.h>
#include <time.h>

#include <tether/client/sut_clock.h>

namespace tether::client {
namespace {

Duration read_clock(clockid_t clock) {
  timespec t{};
  ::clock_gettime(clock, &t);
  return std::chrono::seconds(t.tv_sec) + Duration(t.tv_nsec);
}

Duration scaled(Duration measured, double factor) {
  if (factor == 1.0) return measured;
  return Duration(std::llround(static_cast<double>(measured.count()) * factor));
}

class WallSource final : public TimeSource {
 public:
  explicit WallSource(double factor) : factor_(factor) {}
  link::ClockKind kind() const override { return link::ClockKind::kWall; }
  double factor() const override { return factor_; }
  Duration elapsed() const override {
    return scaled(read_clock(CLOCK_MONOTONIC) - origin_, factor_);
  }

 private:
  double factor_;
  Duration origin_ = read_clock(CLOCK_MONOTONIC);  // small numbers lose nothing when scaled
};

class CpuSource final : public TimeSource {
 public:
  explicit CpuSource(double factor) : factor_(factor) {}

  link::ClockKind kind() const override { return link::ClockKind::kCpu; }
  double factor() const override { return factor_; }
  Duration elapsed() const override;
  void exclude_calling_thread() override;
  void release_calling_thread() override;

 private:
  Duration measured() const;

  double factor_;
  mutable std::mutex mutex_;
  mutable Duration newest_{0};  // guarded by mutex_, as what follows
  std::optional<clockid_t> excluded_clock_;
  Duration excluded_before_{0};  // what excluded threads used, without the present one's clock
};

Duration CpuSource::elapsed() const {
  const std::lock_guard lock(mutex_);
  // The two clocks behind `measured` cannot be read at the same instant; what that may take back is
  // held back.
  newest_ = std::max(newest_, scaled(measured(), factor_));
  return newest_;
}

Duration CpuSource::measured() const {
  if (!excluded_clock_) return read_clock(CLOCK_PROCESS_CPUTIME_ID) - excluded_before_;
  // Reads again if the excluded thread ran in between.
  for (int attempt = 0;; ++attempt) {
    const Duration before = read_clock(*excluded_clock_);
    const Duration process = read_clock(CLOCK_PROCESS_CPUTIME_ID);
    const Duration after = read_clock(*excluded_clock_);
    if (before == after || attempt == 3) return process - excluded_before_ - after;
  }
}

void CpuSource::exclude_calling_thread() {
  clockid_t clock{};
  if (::pthread_getcpuclockid(::pthread_self(), &clock) != 0) return;
  const std::lock_guard lock(mutex_);
  excluded_before_ -= read_clock(clock);
  excluded_clock_ = clock;
}

void CpuSource::release_calling_thread() {
  const std::lock_guard lock(mutex_);
  if (!excluded_clock_) return;
  excluded_before_ += read_clock(*excluded_clock_);
  excluded_clock_.reset();
}

class ScriptedSource final : public TimeSource {
 public:
  explicit ScriptedSource(Duration step) : step_(step) {}
  link::ClockKind kind() const override { return link::ClockKind::kScripted; }
  Duration computing() const override { return step_; }
  Duration elapsed() const override { return ++readings_ * step_; }

 private:
  Duration step_;
  mutable std::atomic<std::int64_t> readings_{0};
};

}  // namespace

std::unique_ptr<TimeSource> make_wall_source(double factor) {
  return std::make_unique<WallSource>(factor);
}
std::unique_ptr<TimeSource> make_cpu_source(double factor) {
  return std::make_unique<CpuSource>(factor);
}
std::unique_ptr<TimeSource> make_scripted_source(Duration step) {
  return std::make_unique<ScriptedSource>(step);
}

}  // namespace tether::client
