#include <algorithm>
#include <cassert>

#include <tether/sync/barrier_synchronizer.h>

namespace tether::sync {

std::string_view name(SyncPolicy policy) {
  return policy == SyncPolicy::kConservativeBarrier ? "conservative_barrier" : "free_running";
}

std::string_view name(CausalityViolation::Kind) {
  return "request in the past";
}

SutIndex BarrierSynchronizer::add(ExecTime start) {
  suts_.push_back({State::kComputing, start});
  return suts_.size() - 1;
}

void BarrierSynchronizer::remove(SutIndex sut) {
  suts_[sut].state = State::kGone;
}

void BarrierSynchronizer::progress(SutIndex sut, ExecTime reached) {
  Sut& s = suts_[sut];
  if (s.state == State::kComputing) s.bound = std::max(s.bound, reached);
}

Arrival BarrierSynchronizer::arrive(SutIndex sut, ExecTime issued_at, SimTime st) {
  Sut& s = suts_[sut];
  assert(s.state == State::kComputing && st <= horizon());

  Arrival arrival{.charged_at = std::max(issued_at, s.bound)};
  if (issued_at < s.bound)
    arrival.violation = {CausalityViolation::Kind::kRequestInThePast, s.bound - issued_at};
  arrival.lag = lag(arrival.charged_at, st);
  s.bound = arrival.charged_at;
  return arrival;
}

void BarrierSynchronizer::hold(const TimeAdvanceRequest& request) {
  Sut& s = suts_[request.sut];
  assert(s.state == State::kComputing && request.reply_at >= s.bound);
  s = {State::kHeld, request.reply_at};
}

SimTime BarrierSynchronizer::horizon() const {
  SimTime least = SimTime::max();
  for (const Sut& s : suts_)
    if (s.state != State::kGone) least = std::min(least, grid_.floor(same_instant(s.bound)));
  return least;
}

// A command stamped t by another SUT acts at ceil(t). It would count as "earlier, and in effect at
// st" only if t < reply and ceil(t) ≤ st = floor(reply): impossible once that SUT's bound is beyond
// st, or is not before the reply itself.
bool BarrierSynchronizer::may_resume(SutIndex sut, SimTime st) const {
  const ExecTime reply_at = suts_[sut].bound;
  if (grid_.floor(same_instant(reply_at)) != st) return false;
  return std::all_of(suts_.begin(), suts_.end(), [&](const Sut& other) {
    return other.state != State::kComputing || same_instant(other.bound) > st ||
           other.bound >= reply_at;
  });
}

std::optional<TimeAdvanceGrant> BarrierSynchronizer::release(SimTime st) {
  std::optional<SutIndex> next;
  for (SutIndex i = 0; i < suts_.size(); ++i) {
    if (suts_[i].state != State::kHeld || !may_resume(i, st)) continue;
    if (!next || suts_[i].bound < suts_[*next].bound) next = i;
  }
  if (!next) return std::nullopt;
  suts_[*next].state = State::kComputing;
  return TimeAdvanceGrant{*next, suts_[*next].bound, st};
}

std::optional<SutIndex> BarrierSynchronizer::slowest_computing() const {
  std::optional<SutIndex> slowest;
  for (SutIndex i = 0; i < suts_.size(); ++i) {
    if (suts_[i].state != State::kComputing) continue;
    if (!slowest || suts_[i].bound < suts_[*slowest].bound) slowest = i;
  }
  return slowest;
}

}  // namespace tether::sync
