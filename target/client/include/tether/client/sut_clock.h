#pragma once

#include <memory>
#include <string>

#include <tether/base/result.h>
#include <tether/base/time.h>
#include <tether/client/exec/computed.h>
#include <tether/computer/clock.h>

namespace tether::client {

/// Source of a SUT's execution time (docs/design.md section 2, "How a SUT's time is measured").
/// Monotone. Thread-safe.
class TimeSource {
 public:
  virtual ~TimeSource() = default;
  virtual computer::Clock clock() const = 0;
  /// Measured time since an arbitrary origin, scaled by the clock's factor. Each reading of a
  /// scripted source advances it by Clock::computing.
  virtual Duration elapsed() const = 0;
  /// The same for a SUT that is about to go on: what reading takes is before the measured instant,
  /// not after it, so that it is not charged.
  virtual Duration elapsed_at_resume() const { return elapsed(); }
  /// The SUT has read its stamp, and waits for a reply until `elapsed_at_resume()`.
  virtual void hold() const {}
  /// What other threads of the process have computed between hold() and elapsed_at_resume(),
  /// scaled, if that is measured and counted nowhere else.
  virtual Duration computed_beside() const { return Duration::zero(); }
  /// What each part of the program has computed so far, in proportion to each other; empty: it has
  /// no parts.
  virtual Computed computed_by_parts() const { return {}; }
  /// The part of `elapsed()` that threads other than the calling one have computed.
  virtual Duration computed_by_others() const { return Duration::zero(); }
  /// The part of the last `elapsed()` that processes started by the SUT's have computed. Monotone.
  virtual Duration elapsed_in_children() const { return Duration::zero(); }
  /// Of a replayed source: the SUT has computed for so long.
  virtual void charge(Duration) {}
  /// Fails with kRefused if a part of the SUT's computing is not in `elapsed()`.
  virtual Status complete() const { return ok_status(); }

  /// So much of what the calling thread has computed was work for the client library: it is not
  /// counted. Only if computing is what is measured.
  virtual void leave_out(Duration) {}
  /// What is counted of the calling thread's computing so far. Only if that is what is measured.
  virtual Duration counted_of_thread() const { return Duration(0); }
  /// The same where that begins which leave_out() will be of.
  virtual Duration begin_to_leave_out() { return counted_of_thread(); }

  /// Until its release, the calling thread works for the client library; a source that measures
  /// threads separately does not count it. One thread at a time.
  virtual void exclude_calling_thread() {}
  /// @pre the calling thread is excluded
  virtual void release_calling_thread() {}
};

/// CPU time of this process without that of the calling thread.
Duration cpu_time_of_other_threads();

/// The machine's monotonic clock × factor. A factor other than 1 is a virtual target on which
/// waiting counts as well as computing; for programs of several threads.
/// @pre factor > 0
std::unique_ptr<TimeSource> make_wall_source(double factor = 1.0);
/// CPU time × factor: a virtual target. Counted are all threads of this process except an excluded
/// one, and all processes that it has started, those that they have started, and so on, while they
/// run and after they have ended. A process that this one did not start is not counted, also if it
/// computes for this one (a service, a container).
///
/// Makes this process the parent of descendants whose own parent ends (PR_SET_CHILD_SUBREAPER).
/// While it has children, reading takes some 10 µs for each, which are not counted. `complete()`
/// fails if this process or a living descendant ignores SIGCHLD, or this one has SA_NOCLDWAIT:
/// the kernel then drops the CPU time of children that end.
/// @pre factor > 0
std::unique_ptr<TimeSource> make_cpu_source(double factor);
/// A scripted SUT, which computes for `step` between two interactions, independent of the machine:
/// time advances by `step` each time it is read, which each interaction, `now()` and annotation
/// does once. For tests, and for runs that must be reproducible to the byte.
std::unique_ptr<TimeSource> make_scripted_source(Duration step);

/// A source that advances by what the coordinator gives each stage (link::Reply::computing),
/// however long the program really computes. Between stages and calls, time stands still.
std::unique_ptr<TimeSource> make_replayed_source();

/// The source that TETHER_CLOCK names (computer::parse_clock). Fails with kInvalid and the allowed
/// values. For "counted", TETHER_COUNTS names the page of counts; fails with kRefused if several
/// threads or processes of the program compute.
Result<std::unique_ptr<TimeSource>> parse_time_source(const std::string& text);

/// ET of this SUT: runs with its source, is stopped while the SUT is held, and continues from
/// exactly the given timestamp (paper, Section II: the paused timer; docs/design.md section 2,
/// rules 5 and 6).
///
/// hold() and resume(t_rep) enclose each interaction. What child processes compute between them is
/// added after resume(). Not thread-safe; `source` must outlive it.
class SutClock {
 public:
  explicit SutClock(const TimeSource& source, ExecTime start = ExecTime{});

  /// ET now.
  ExecTime now() const;
  /// Stops the clock and returns ET, the timestamp of the request. Idempotent while held.
  ExecTime hold();
  /// Continues with ET = `at`, to which what children computed since hold() is added at once. @pre
  /// is_held(), and `at` ≥ what hold() returned
  void resume(ExecTime at);
  bool is_held() const { return held_; }

 private:
  const TimeSource* source_;
  ExecTime base_et_;
  Duration base_source_;
  Duration children_at_hold_{0};
  bool held_ = false;
};

}  // namespace tether::client
