#include <algorithm>
#include <cassert>
#include <tuple>

#include <tether/sync/barrier_synchronizer.h>

namespace tether::sync {

std::string_view name(SyncPolicy policy) {
  return policy == SyncPolicy::kConservativeBarrier ? "conservative_barrier" : "free_running";
}

std::string_view name(CausalityViolation::Kind) {
  return "request in the past";
}

SutIndex BarrierSynchronizer::add(ExecTime start, SutKind kind) {
  Sut& sut = suts_.emplace_back(Sut{.kind = kind, .bound = start, .calls = {}});
  sut.calls.reserve(sut.is_serial() ? 1 : kMaxOpenCalls);
  return suts_.size() - 1;
}

void BarrierSynchronizer::remove(SutIndex sut) {
  suts_[sut].gone = true;
  suts_[sut].calls.clear();
}

void BarrierSynchronizer::progress(SutIndex sut, ExecTime reached) {
  Sut& s = suts_[sut];
  if (!s.gone && !is_held(sut)) s.bound = std::max(s.bound, reached);
}

void BarrierSynchronizer::stop(SutIndex sut, ExecTime at) {
  Sut& s = suts_[sut];
  assert(!s.gone && !s.is_serial() && at >= s.bound);
  s.bound = s.stopped_at = at;
}

Arrival BarrierSynchronizer::arrive(SutIndex sut, ExecTime issued_at, SimTime st) {
  Sut& s = suts_[sut];
  assert(s.is_computing() && st <= lower_bound());

  Arrival arrival{.charged_at = std::max(issued_at, s.bound)};
  if (issued_at < s.bound)
    arrival.violation = {CausalityViolation::Kind::kRequestInThePast, s.bound - issued_at};
  arrival.lag = lag(arrival.charged_at, st);
  s.bound = arrival.charged_at;
  s.stopped_at = ExecTime::min();
  return arrival;
}

void BarrierSynchronizer::hold(const TimeAdvanceRequest& request) {
  Sut& s = suts_[request.sut];
  assert(s.is_computing() && request.reply_at >= s.bound && s.calls.size() < kMaxOpenCalls);
  s.calls.push_back({request.call, request.reply_at});
  if (s.is_serial()) s.bound = request.reply_at;
}

SimTime BarrierSynchronizer::lower_bound() const {
  SimTime least = SimTime::max();
  for (const Sut& s : suts_) {
    if (!s.gone) least = std::min(least, grid_.floor(same_instant(s.bound)));
    for (const Call& call : s.calls)
      least = std::min(least, grid_.floor(same_instant(call.reply_at)));
  }
  return least;
}

// A command stamped t by another SUT acts at ceil(t). It must be in effect before the reply only if
// t < reply and ceil(t) ≤ st = floor(reply): impossible once that SUT's bound is beyond st, or is
// not before the reply itself. A concurrent SUT's own earlier commands have arrived once it has
// stopped.
bool BarrierSynchronizer::may_resume(SutIndex sut, const Call& call, SimTime st) const {
  if (grid_.floor(same_instant(call.reply_at)) != st || !suts_[sut].waits_for(call)) return false;
  return std::all_of(suts_.begin(), suts_.end(), [&](const Sut& other) {
    return !other.is_computing() || same_instant(other.bound) > st || other.bound >= call.reply_at;
  });
}

std::optional<TimeAdvanceGrant> BarrierSynchronizer::release(SimTime st) {
  std::optional<TimeAdvanceGrant> next;
  const auto key = [](ExecTime reply_at, SutIndex sut, CallId call) {
    return std::tuple(reply_at, sut, call);
  };
  for (SutIndex i = 0; i < suts_.size(); ++i) {
    for (const Call& call : suts_[i].calls) {
      if (!may_resume(i, call, st)) continue;
      if (!next || key(call.reply_at, i, call.id) < key(next->resume_at, next->sut, next->call))
        next = TimeAdvanceGrant{i, call.reply_at, st, call.id};
    }
  }
  if (next)
    std::erase_if(suts_[next->sut].calls, [&](const Call& call) { return call.id == next->call; });
  return next;
}

bool BarrierSynchronizer::is_held(SutIndex sut) const {
  const Sut& s = suts_[sut];
  return std::any_of(s.calls.begin(), s.calls.end(),
                     [&](const Call& call) { return s.waits_for(call); });
}

std::optional<SutIndex> BarrierSynchronizer::slowest_computing() const {
  std::optional<SutIndex> slowest;
  for (SutIndex i = 0; i < suts_.size(); ++i) {
    if (suts_[i].gone || is_held(i)) continue;
    if (!slowest || suts_[i].bound < suts_[*slowest].bound) slowest = i;
  }
  return slowest;
}

}  // namespace tether::sync
