#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include <tether/base/time.h>

namespace tether::sync {

/// How SUTs and the simulation are synchronised.
enum class SyncPolicy {
  kConservativeBarrier,  ///< by the barrier below
  kFreeRunning,          ///< not synchronised: the baseline (DESIGN section 2, rule 8)
};
/// "conservative_barrier", "free_running".
std::string_view name(SyncPolicy policy);

/// Index of a SUT in the order of `add`.
using SutIndex = std::size_t;

/// How the calls of a SUT relate to its execution time (DESIGN section 2, "Several threads").
enum class SutKind : std::uint8_t {
  kSerial,      ///< one call at a time, during which its ET is paused
  kConcurrent,  ///< several open calls, during which its ET continues until it reports a stop
};

/// Identifies an open call of one SUT; chosen by the caller (the sequence of a request). Not used
/// for serial SUTs.
using CallId = std::uint64_t;

/// Open calls of one concurrent SUT.
inline constexpr std::size_t kMaxOpenCalls = 64;

/// A timestamp that the barrier could not use. Does not happen if the clock of the SUT is correct.
struct CausalityViolation {
  enum class Kind {
    kRequestInThePast,  ///< stamped before the last reply, or before a progress of the SUT
  };
  Kind kind = Kind::kRequestInThePast;
  Duration size{0};  ///< by how much; > 0
};
std::string_view name(CausalityViolation::Kind kind);

/// A request on its arrival.
struct Arrival {
  ExecTime charged_at;  ///< the stamp, or the SUT's bound if the stamp was before it
  Duration lag{0};      ///< ε = charged_at − ST on arrival (paper, Fig. 3)
  std::optional<CausalityViolation> violation{};
};

/// Request to hold a call until ST has reached `reply_at`.
struct TimeAdvanceRequest {
  SutIndex sut = 0;
  ExecTime reply_at;
  CallId call = 0;
  /// Of a call that waits for messages of other SUTs: the least time that a message takes. The
  /// reply is sent when no other SUT can send one any more that would arrive before it.
  std::optional<Duration> lookahead{};
};

/// An instant of one SUT. In the order of time; at one instant, in the order of indices.
struct SutTime {
  ExecTime at;
  SutIndex sut = 0;
  friend auto operator<=>(const SutTime&, const SutTime&) = default;
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
/// A *serial* SUT is either *computing*, with a bound: the last ET that it is known to have
/// reached, before which it can stamp nothing; or *held*, with the timestamp of its reply, at which
/// it resumes.
///
///     arrive(sut, stamp, ST) → hold(sut, reply_at) → ST advances up to lower_bound() → release(ST)
///
/// A *concurrent* SUT is always computing, with a bound that its stamps, `progress` and `stop`
/// raise. In addition, each of its open calls is held, each with its timestamp.
///
///     arrive, hold; arrive, hold; stop(sut, ET) → … → release(ST), for each call that is due by ET
///
/// Guarantees, for any schedule:
///  - ST ≤ lower_bound() = min over all SUTs and open calls of floor(bound or reply_at): no later
///    request is in the simulator's past (rule 4);
///  - a reply stamped t is sent at ST = floor(t), once no other SUT can put a command with a stamp
///    earlier than t into effect at or before that boundary (rule 3);
///  - to a concurrent SUT it is sent while the SUT is stopped at an ET ≥ t. So no request with an
///    earlier stamp can follow, and its replies are sent in the order of (t, call), at any speed of
///    the simulator.
///  - a call with a lookahead is released at t when each other SUT has a bound (of a held one, the
///    timestamp of its reply) that is later than t − lookahead, or equal to it and of a greater
///    index.
/// Progress: if each computing SUT requests or reports progress again, and each concurrent one
/// stops when a reply is due, every held call is released.
///
/// Each function takes a number of steps that is logarithmic in the number of SUTs. Not
/// thread-safe. Allocates only in `add`.
class BarrierSynchronizer {
 public:
  explicit BarrierSynchronizer(StepGrid grid);
  ~BarrierSynchronizer();
  BarrierSynchronizer(BarrierSynchronizer&&) noexcept;
  BarrierSynchronizer& operator=(BarrierSynchronizer&&) noexcept;

  /// A SUT joins, computing, with ET = `start`. @pre same_instant(start) ≥ the simulation's present
  /// ST.
  SutIndex add(ExecTime start, SutKind kind = SutKind::kSerial);
  /// It left (finished, lost): it and its open calls no longer bound ST. Its index is not reused.
  void remove(SutIndex sut);

  /// A computing SUT reports that its ET has reached `reached`. Ignored if it is held, or if this
  /// is not beyond its bound.
  void progress(SutIndex sut, ExecTime reached);

  /// All threads of a concurrent SUT are stopped since its ET was `at`, and all of its requests up
  /// to then have arrived; it resumes when each call due by then has been released.
  /// `knows_moved`: it has stopped for the calls that were moved up, too. @pre concurrent, at ≥
  /// bound(sut).
  void stop(SutIndex sut, ExecTime at, bool knows_moved = true);

  /// A request of a computing SUT, stamped `issued_at`, arrived when the simulation was at `st`.
  /// The SUT's bound becomes `charged_at`; a concurrent one counts as running until its next stop.
  /// @pre computing, st ≤ lower_bound().
  Arrival arrive(SutIndex sut, ExecTime issued_at, SimTime st);

  /// Holds the call until ST has reached its `reply_at`. @pre `arrive` was called; reply_at ≥
  /// charged_at; of a concurrent SUT, no open call has this id, and fewer than kMaxOpenCalls are
  /// open.
  void hold(const TimeAdvanceRequest& request);

  /// A message has arrived for a held call: its reply is due earlier. A concurrent SUT waits for it
  /// only from the next `stop` with `knows_moved` on. @pre the call is open, its request's
  /// timestamp ≤ reply_at ≤ its present reply_at, floor(reply_at) ≥ ST.
  void move_up(SutIndex sut, CallId call, ExecTime reply_at);

  /// The lower bound on the timestamps of later requests, at its step boundary: the simulation must
  /// not step past it. SimTime::max() without SUTs.
  SimTime lower_bound() const;

  /// Releases the held call with the least (reply_at, SUT, call), if it may be answered at `st`;
  /// call again until there is none. `message`: the next instant at which a message in transit may
  /// arrive; a call with a lookahead that is not before it stays held. @pre st ≤ lower_bound(),
  /// every command with effect ≤ st has been applied.
  std::optional<TimeAdvanceGrant> release(SimTime st, const std::optional<SutTime>& message = {});

  /// The least instant at which a SUT may still send something: its bound or, of a held one, the
  /// timestamp of its reply. None without SUTs.
  std::optional<SutTime> earliest() const;

  /// It waits for a reply: a serial SUT with its call open; a concurrent one that has stopped where
  /// a reply was due.
  bool is_held(SutIndex sut) const;
  /// Lower bound on its ET; of a held serial SUT, the timestamp of its reply.
  ExecTime bound(SutIndex sut) const { return suts_[sut].bound; }

 private:
  struct Call {
    CallId id = 0;
    ExecTime reply_at;
    std::optional<Duration> lookahead;
    bool is_moved = false;  // up, and its concurrent SUT has not stopped for it yet
  };
  struct Sut {
    SutKind kind = SutKind::kSerial;
    bool gone = false;
    ExecTime bound;
    ExecTime stopped_at = ExecTime::min();  // of a stopped concurrent SUT
    std::vector<Call> calls;                // open

    bool is_serial() const { return kind == SutKind::kSerial; }
    bool is_computing() const { return !gone && !(is_serial() && !calls.empty()); }
    bool waits_for(const Call& call) const {
      return is_serial() || (!call.is_moved && call.reply_at <= stopped_at);
    }
    const Call* next_call() const;
  };
  struct Trees;

  void update(SutIndex sut);
  bool may_resume(SutIndex sut, const Call& call, SimTime st,
                  const std::optional<SutTime>& message) const;

  StepGrid grid_;
  std::vector<Sut> suts_;
  std::unique_ptr<Trees> trees_;
};

}  // namespace tether::sync
