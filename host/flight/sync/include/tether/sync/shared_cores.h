#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include <tether/base/time.h>

namespace tether::sync {

/// Whole numbers of parts of a nanosecond, which are exact for every share of a core.
__extension__ using CoreUnits = unsigned __int128;

/// The cores that several programs of one board share (DESIGN section 2, "Several programs on one
/// board"): processor sharing. While n programs compute, each gets min(1, cores / n) of a core. The
/// programs have one time line, the board's ET, on which each alternately computes and waits for a
/// reply. Every program computes from ET 0 on.
///
/// What a program has computed is known from its own stamps; when that was on the board's time line
/// depends on what the others computed meanwhile. So the time line is known up to the first
/// instant at which some computing program's work is not known, or at which a waiting one may be
/// woken earlier than announced; `next` goes on up to there, stamp by stamp:
///
///     ask(program, work) → next() → resume(program, reply_at), go_on(program) or leave(program)
///
/// Exact: work is counted in whole parts of a nanosecond. A program computes until the end of the
/// nanosecond in which its work is done, so its stamps are whole nanoseconds, and n equal programs
/// take exactly ⌈work · max(1, n / cores)⌉. The order in which the work becomes known has no
/// effect.
///
/// Pure logic. Not thread-safe. Allocates in the constructor only.
class SharedCores {
 public:
  /// Up to so many programs: the smallest common multiple of the numbers up to it, times 2^62 ns,
  /// is less than 2^127.
  static constexpr std::size_t kMostPrograms = 40;

  /// @pre cores ≥ 1, 1 ≤ programs ≤ kMostPrograms.
  SharedCores(int cores, std::size_t programs);

  /// The program has computed `work` of its own since it resumed, or more. Ignored if it has asked.
  void progress(std::size_t program, Duration work);
  /// Its next stamp is when it has computed exactly `work` since it resumed, as if alone.
  /// @pre it has not asked, has not left; 0 ≤ work < 2^62 ns, and not less than before.
  void ask(std::size_t program, Duration work);

  struct Stamp {
    std::size_t program = 0;
    ExecTime at;  ///< ET of the board
  };
  /// A program computes on so much of a core from `from` until `to`.
  struct Use {
    std::size_t program = 0;
    ExecTime from;
    ExecTime to;
    double cores = 0.0;
  };
  using Used = std::function<void(const Use&)>;
  /// The next stamp, in the order of (ET, program); none until more is known. Then call `go_on`,
  /// `resume` or `leave` for that program before any other function. The time line does not go on
  /// beyond `until`. `used` gets what the programs compute on the way, in the order of time.
  std::optional<Stamp> next(ExecTime until = ExecTime::max(), const Used& used = {});
  /// It computes on without a break.
  void go_on(std::size_t program) { programs_[program].phase = Phase::kComputing; }
  /// It waits until `at`, and computes from then on. While it waits, also: it is woken at `at`
  /// already. @pre at ≥ its last stamp, and ≥ where the time line has come to.
  void resume(std::size_t program, ExecTime at);
  /// It computes no more.
  void leave(std::size_t program) { programs_[program].phase = Phase::kLeft; }

  /// No later stamp of the program is earlier: what is known of its work takes as long alone.
  ExecTime bound(std::size_t program) const;

 private:
  enum class Phase { kComputing, kStamped, kWaiting, kLeft };
  struct Program {
    Phase phase = Phase::kComputing;
    ExecTime resumes_at{};   // if waiting
    CoreUnits computed = 0;  // since it resumed
    CoreUnits known = 0;     // of its work
    bool asked = false;
  };

  CoreUnits units(Duration work) const { return CoreUnits(work.count()) * per_ns_; }
  static Duration rounded_up(CoreUnits work, CoreUnits rate);

  CoreUnits cores_;
  CoreUnits per_ns_;  // units: divisible by every number of programs
  ExecTime now_{};    // the time line is known up to here
  std::vector<Program> programs_;
};

}  // namespace tether::sync
