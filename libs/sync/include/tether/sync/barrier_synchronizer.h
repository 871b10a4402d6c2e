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

/// A held SUT's request that it be resumed once ST has caught up with `reply_at`.
struct TimeAdvanceRequest {
  SutIndex sut = 0;
  ExecTime reply_at;
};

/// Permission to send the reply.
struct TimeAdvanceGrant {
  SutIndex sut = 0;
  ExecTime resume_at;   ///< = the request's reply_at, exactly (rule 5)
  SimTime released_at;  ///< = floor(reply_at / dt)·dt (rule 3)
};

/// The conservative barrier (paper, Section II; DESIGN section 2, rules 3 to 5) for any number of
/// SUTs: pure logic, timestamps in, decisions out.
///
/// Each SUT is either *computing*, with a bound: the last ET it is known to have reached, below
/// which it can stamp nothing any more; or *held*, with the timestamp of its reply, at which it
/// will go on.
///
///     arrive(sut, stamp, ST) → hold(sut, reply_at) → ST advances up to horizon() → release(ST)
///
/// Two guarantees, for any schedule:
///  - ST ≤ horizon() = min over all SUTs of floor(bound or reply_at): nothing that can still be
///    requested lies in the simulator's past (rule 4);
///  - a reply stamped t leaves at ST = floor(t), when no other SUT can any more put a command into
///    effect at or before that boundary with a stamp earlier than t (rule 3).
/// And one of progress: as long as some SUT is held and those computing come back, some SUT gets
/// released.
///
/// Not thread-safe. Allocates only in `add`.
class BarrierSynchronizer {
 public:
  explicit BarrierSynchronizer(StepGrid grid) : grid_(grid) {}

  /// A SUT joins, computing, with ET = `start`. @pre same_instant(start) ≥ the simulation's present
  /// ST.
  SutIndex add(ExecTime start);
  /// It left (finished, lost): it bounds nothing any more. Its index is not used again.
  void remove(SutIndex sut);

  /// A computing SUT has let known that its ET reached `reached`. Ignored where it is held, or not
  /// beyond its bound.
  void progress(SutIndex sut, ExecTime reached);

  /// A request of a computing SUT, stamped `issued_at`, arrived when the simulation was at `st`.
  /// The SUT's bound becomes `charged_at`. @pre computing, st ≤ horizon().
  Arrival arrive(SutIndex sut, ExecTime issued_at, SimTime st);

  /// Holds it until ST has caught up. @pre `arrive` was called; reply_at ≥ charged_at.
  void hold(const TimeAdvanceRequest& request);

  /// The least ST that the simulation must not step past; SimTime::max() when no SUT is left.
  SimTime horizon() const;

  /// Releases the held SUT with the least (reply_at, index) of those that may go on at `st`, if
  /// there is one; call again until there is none. @pre st ≤ horizon(), every command with effect ≤
  /// st has been applied.
  std::optional<TimeAdvanceGrant> release(SimTime st);

  /// The computing SUT with the least bound: whom everything waits for once ST is at the horizon.
  /// None if no SUT is computing.
  std::optional<SutIndex> slowest_computing() const;

  bool is_held(SutIndex sut) const { return suts_[sut].state == State::kHeld; }
  /// ET that it has reached at least; of a held SUT, the timestamp of its reply.
  ExecTime bound(SutIndex sut) const { return suts_[sut].bound; }

 private:
  enum class State : std::uint8_t { kComputing, kHeld, kGone };
  struct Sut {
    State state = State::kComputing;
    ExecTime bound;
  };

  bool may_resume(SutIndex sut, SimTime st) const;

  StepGrid grid_;
  std::vector<Sut> suts_;
};

}  // namespace tether::sync
