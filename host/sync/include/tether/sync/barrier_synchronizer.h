#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include <tether/base/step_grid.h>
#include <tether/base/time.h>

namespace tether::sync {

/// How SUTs are tied to the simulation.
enum class SyncPolicy {
  kConservativeBarrier,  ///< by the barrier below
  kFreeRunning,          ///< not at all: the baseline (DESIGN section 2, rule 8)
};
/// "conservative_barrier", "free_running".
std::string_view name(SyncPolicy policy);

/// Index of a SUT in the order of `add`.
using SutIndex = std::size_t;

/// How a SUT's own calls meet its execution time (DESIGN section 2, "Several threads").
enum class SutKind : std::uint8_t {
  kSerial,      ///< one call at a time, for which its ET stands still
  kConcurrent,  ///< several open calls; ET goes on meanwhile, and stands still when it says so
};

/// Tells one SUT's open calls apart; the caller's choice (a request's sequence). Of a serial SUT
/// without meaning.
using CallId = std::uint64_t;

/// Open calls of one concurrent SUT.
inline constexpr std::size_t kMaxOpenCalls = 64;

/// A timestamp that the barrier could not honour. Never happens with a SUT whose clock is sound.
struct CausalityViolation {
  enum class Kind {
    kRequestInThePast,  ///< stamped before the last reply, or before a progress that the SUT itself
                        ///< had reported
  };
  Kind kind = Kind::kRequestInThePast;
  Duration size{0};  ///< by how much; > 0
};
std::string_view name(CausalityViolation::Kind kind);

/// How a request met the simulation.
struct Arrival {
  ExecTime charged_at;  ///< the stamp, or the SUT's bound if the stamp was before it
  Duration lag{0};      ///< ε = charged_at − ST on arrival (paper, Fig. 3)
  std::optional<CausalityViolation> violation{};
};

/// A held call's request that it be answered once ST has caught up with `reply_at`.
struct TimeAdvanceRequest {
  SutIndex sut = 0;
  ExecTime reply_at;
  CallId call = 0;
};

/// Permission to send the reply.
struct TimeAdvanceGrant {
  SutIndex sut = 0;
  ExecTime resume_at;   ///< = the request's reply_at, exactly (rule 5)
  SimTime released_at;  ///< = floor(reply_at / dt)·dt (rule 3)
  CallId call = 0;
};

/// The conservative barrier (paper, Section II; DESIGN section 2, rules 3 to 5) for any number of
/// SUTs: pure logic, timestamps in, decisions out.
///
/// A *serial* SUT is either *computing*, with a bound: the last ET it is known to have reached,
/// below which it can stamp nothing any more; or *held*, with the timestamp of its reply, at which
/// it will go on.
///
///     arrive(sut, stamp, ST) → hold(sut, reply_at) → ST advances up to horizon() → release(ST)
///
/// A *concurrent* SUT is always computing, with a bound that its stamps, `progress` and `stop`
/// raise; beside that each of its open calls is held, with a timestamp of its own.
///
///     arrive, hold; arrive, hold; stop(sut, ET) → … → release(ST), for each call that is due by ET
///
/// Guarantees, for any schedule:
///  - ST ≤ horizon() = min over all SUTs and open calls of floor(bound or reply_at): nothing that
///    can still be requested lies in the simulator's past (rule 4);
///  - a reply stamped t leaves at ST = floor(t), when no other SUT can any more put a command into
///    effect at or before that boundary with a stamp earlier than t (rule 3);
///  - of a concurrent SUT, it leaves while the SUT stands still at an ET ≥ t. So no request stamped
///    earlier can still come from it, and its replies leave in the order of (t, call), however fast
///    the simulator is.
/// And one of progress: as long as some SUT is held, those computing come back, and concurrent ones
/// stop when a reply is due, some call gets released.
///
/// Not thread-safe. Allocates only in `add`.
class BarrierSynchronizer {
 public:
  explicit BarrierSynchronizer(StepGrid grid) : grid_(grid) {}

  /// A SUT joins, computing, with ET = `start`. @pre same_instant(start) ≥ the simulation's present
  /// ST.
  SutIndex add(ExecTime start, SutKind kind = SutKind::kSerial);
  /// It left (finished, lost): neither it nor its open calls bound anything any more. Its index is
  /// not used again.
  void remove(SutIndex sut);

  /// A computing SUT has let known that its ET reached `reached`. Ignored where it is held, or not
  /// beyond its bound.
  void progress(SutIndex sut, ExecTime reached);

  /// All of a concurrent SUT stands still, since its ET was `at`, and everything that it requested
  /// up to then has arrived; it goes on from there when each call due by then has been released.
  /// @pre concurrent, at ≥ bound(sut).
  void stop(SutIndex sut, ExecTime at);

  /// A request of a computing SUT, stamped `issued_at`, arrived when the simulation was at `st`.
  /// The SUT's bound becomes `charged_at`; a concurrent one is taken to run until its next stop.
  /// @pre computing, st ≤ horizon().
  Arrival arrive(SutIndex sut, ExecTime issued_at, SimTime st);

  /// Holds the call until ST has caught up. @pre `arrive` was called; reply_at ≥ charged_at; of a
  /// concurrent SUT, no open call has this id, and fewer than kMaxOpenCalls are open.
  void hold(const TimeAdvanceRequest& request);

  /// The least ST that the simulation must not step past; SimTime::max() when no SUT is left.
  SimTime horizon() const;

  /// Releases the held call with the least (reply_at, SUT, call) of those that may go on at `st`,
  /// if there is one; call again until there is none. @pre st ≤ horizon(), every command with
  /// effect ≤ st has been applied.
  std::optional<TimeAdvanceGrant> release(SimTime st);

  /// The SUT with the least bound of those that are not held: whom everything waits for once ST is
  /// at the horizon. None if there is none.
  std::optional<SutIndex> slowest_computing() const;

  /// It stands still until a reply of ours: a serial SUT with its call open; a concurrent one that
  /// stopped where one was due.
  bool is_held(SutIndex sut) const;
  /// ET that it has reached at least; of a held serial SUT, the timestamp of its reply.
  ExecTime bound(SutIndex sut) const { return suts_[sut].bound; }

 private:
  struct Call {
    CallId id = 0;
    ExecTime reply_at;
  };
  struct Sut {
    SutKind kind = SutKind::kSerial;
    bool gone = false;
    ExecTime bound;
    ExecTime stopped_at = ExecTime::min();  // of a concurrent SUT that stands still
    std::vector<Call> calls;                // open

    bool is_serial() const { return kind == SutKind::kSerial; }
    bool is_computing() const { return !gone && !(is_serial() && !calls.empty()); }
    bool waits_for(const Call& call) const { return is_serial() || call.reply_at <= stopped_at; }
  };

  bool may_resume(SutIndex sut, const Call& call, SimTime st) const;

  StepGrid grid_;
  std::vector<Sut> suts_;
};

}  // namespace tether::sync
