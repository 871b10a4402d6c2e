// What the clocks of the design's section 2 measure, one class each. CpuSource adds the CPU time of
// the own process and of its descendants, and leaves out threads of this library.

#include "clocks/descendants.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include <pthread.h>
#include <sys/single_threaded.h>

#include <tether/client/sut_clock.h>
#include <tether/os/machine.h>
#include <tether/os/process_table.h>

namespace tether::client {
namespace {

using os::read_clock;

Duration scaled(Duration measured, double factor) {
  if (factor == 1.0) return measured;
  return Duration(std::llround(static_cast<double>(measured.count()) * factor));
}

class WallSource final : public TimeSource {
 public:
  explicit WallSource(double factor) : factor_(factor) {}
  computer::Clock clock() const override { return {computer::ClockKind::kWall, factor_}; }
  Duration elapsed() const override {
    return scaled(read_clock(CLOCK_MONOTONIC) - origin_, factor_);
  }

 private:
  double factor_;
  Duration origin_ = read_clock(CLOCK_MONOTONIC);  // small numbers lose nothing when scaled
};

// Of the calling thread, by leave_out and for looking at children.
thread_local Duration t_left_out __attribute__((tls_model("initial-exec"))){0};

class CpuSource final : public TimeSource {
 public:
  explicit CpuSource(double factor) : factor_(factor) { os::adopt_orphans(); }

  computer::Clock clock() const override { return {computer::ClockKind::kCpu, factor_}; }
  Duration elapsed() const override;
  Duration elapsed_at_resume() const override;
  Duration elapsed_in_children() const override;
  void hold() const override;
  Duration computed_beside() const override;
  Duration computed_by_others() const override;
  Status complete() const override;
  void leave_out(Duration computed) override {
    const std::lock_guard lock(mutex_);
    exclude(computed);
  }
  Duration counted_of_thread() const override {
    return read_clock(CLOCK_THREAD_CPUTIME_ID) - t_left_out;
  }
  void exclude_calling_thread() override;
  void release_calling_thread() override;

 private:
  void read_own() const;
  void read_children() const;
  Duration own() const;
  /// What threads other than the calling one have computed.
  Duration of_others() const { return own() - counted_of_thread(); }
  Duration children() const;
  void exclude(Duration of_thread) const {
    excluded_before_ += of_thread;
    t_left_out += of_thread;
  }

  double factor_;
  mutable std::mutex mutex_;
  // Guarded by mutex_:
  mutable Duration newest_own_{0};
  mutable Duration newest_children_{0};
  mutable std::optional<pid_t> deaf_;
  mutable std::optional<Duration> others_at_hold_;
  mutable Duration beside_{0};
  std::optional<clockid_t> excluded_clock_;
  pthread_t excluded_thread_{};  // if there is excluded_clock_
  // What excluded threads used, without the present one's clock, and looking at children.
  mutable Duration excluded_before_{0};
  const Duration others_before_ = of_others();  // the program's, before it had this clock
};

// What is read here cannot be read at the same instant; what that may take back is held back.
void CpuSource::read_own() const {
  newest_own_ = std::max(newest_own_, own());
}

void CpuSource::read_children() const {
  newest_children_ = std::max(newest_children_, children());
}

Duration CpuSource::elapsed() const {
  const std::lock_guard lock(mutex_);
  read_own();
  read_children();
  return scaled(newest_own_ + newest_children_, factor_);
}

Duration CpuSource::elapsed_at_resume() const {
  const std::lock_guard lock(mutex_);
  // Of one call, it can be less than nothing: the two clocks are not read at one instant.
  if (const auto since = std::exchange(others_at_hold_, std::nullopt))
    beside_ += of_others() - *since;
  read_children();
  read_own();
  return scaled(newest_own_ + newest_children_, factor_);
}

void CpuSource::hold() const {
  const std::lock_guard lock(mutex_);
  if (__libc_single_threaded == 0) others_at_hold_ = of_others();
}

Duration CpuSource::computed_beside() const {
  const std::lock_guard lock(mutex_);
  return scaled(std::max(Duration(0), beside_), factor_);
}

Duration CpuSource::computed_by_others() const {
  const std::lock_guard lock(mutex_);
  return scaled(std::max(Duration(0), of_others() - others_before_ - beside_), factor_);
}

Duration CpuSource::elapsed_in_children() const {
  const std::lock_guard lock(mutex_);
  return scaled(newest_children_, factor_);
}

Duration CpuSource::children() const {
  const Duration waited = used_by_waited_children();
  if (!has_children()) return waited;
  const Duration begin = read_clock(CLOCK_THREAD_CPUTIME_ID);
  const LivingDescendants living = living_descendants();
  if (living.deaf) deaf_ = living.deaf;
  if (!excluded_clock_ || ::pthread_equal(excluded_thread_, ::pthread_self()) == 0) {
    exclude(read_clock(CLOCK_THREAD_CPUTIME_ID) - begin);
  }
  return waited + living.used;
}

Status CpuSource::complete() const {
  const bool is_own = ignores_child_end();
  const std::lock_guard lock(mutex_);
  if (!is_own && !deaf_) return ok_status();
  const std::string process = is_own ? "the program" : "its process " + std::to_string(*deaf_);
  return Failure{Failure::Kind::kRefused,
                 process +
                     " ignores SIGCHLD (SIG_IGN or SA_NOCLDWAIT), so the CPU time of child "
                     "processes is lost when they end. With a CPU clock, handle SIGCHLD or leave "
                     "it at SIG_DFL, and wait for each child"};
}

Duration CpuSource::own() const {
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
  excluded_thread_ = ::pthread_self();
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
  computer::Clock clock() const override { return {computer::ClockKind::kScripted, 1.0, step_}; }
  Duration elapsed() const override { return ++readings_ * step_; }

 private:
  Duration step_;
  mutable std::atomic<std::int64_t> readings_{0};
};

class ReplayedSource final : public TimeSource {
 public:
  computer::Clock clock() const override { return {computer::ClockKind::kReplayed}; }
  Duration elapsed() const override { return Duration(charged_ns_.load()); }
  void charge(Duration computing) override { charged_ns_ += computing.count(); }

 private:
  std::atomic<std::int64_t> charged_ns_{0};
};

}  // namespace

Duration cpu_time_of_other_threads() {
  return read_clock(CLOCK_PROCESS_CPUTIME_ID) - read_clock(CLOCK_THREAD_CPUTIME_ID);
}

std::unique_ptr<TimeSource> make_wall_source(double factor) {
  return std::make_unique<WallSource>(factor);
}
std::unique_ptr<TimeSource> make_cpu_source(double factor) {
  return std::make_unique<CpuSource>(factor);
}
std::unique_ptr<TimeSource> make_scripted_source(Duration step) {
  return std::make_unique<ScriptedSource>(step);
}
std::unique_ptr<TimeSource> make_replayed_source() {
  return std::make_unique<ReplayedSource>();
}

}  // namespace tether::client
