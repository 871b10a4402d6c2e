#include <algorithm>
#include <cassert>
#include <utility>

#include <tether/sync/barrier_synchronizer.h>
#include <tether/sync/least_tree.h>

namespace tether::sync {

// What the decisions need of each SUT, so that they need not look at all of them.
struct BarrierSynchronizer::Trees {
  LeastTree limit;      // ST must not pass it: its bound, and the times of its open calls
  LeastTree reached;    // its bound
  LeastTree computing;  // its bound while it computes
  LeastTree awaited;    // of the calls that it waits for, the earliest reply
};

std::string_view name(SyncPolicy policy) {
  return policy == SyncPolicy::kConservativeBarrier ? "conservative_barrier" : "free_running";
}

std::string_view name(CausalityViolation::Kind) {
  return "request in the past";
}

BarrierSynchronizer::BarrierSynchronizer(StepGrid grid)
    : grid_(grid), trees_(std::make_unique<Trees>()) {}
BarrierSynchronizer::~BarrierSynchronizer() = default;
BarrierSynchronizer::BarrierSynchronizer(BarrierSynchronizer&&) noexcept = default;
BarrierSynchronizer& BarrierSynchronizer::operator=(BarrierSynchronizer&&) noexcept = default;

SutIndex BarrierSynchronizer::add(ExecTime start, SutKind kind) {
  Sut& sut = suts_.emplace_back(Sut{.kind = kind, .bound = start, .calls = {}});
  sut.calls.reserve(sut.is_serial() ? 1 : kMaxOpenCalls);
  for (LeastTree* tree : {&trees_->limit, &trees_->reached, &trees_->computing, &trees_->awaited})
    tree->add();
  update(suts_.size() - 1);
  return suts_.size() - 1;
}

// The call that is released first of those that the SUT waits for.
const BarrierSynchronizer::Call* BarrierSynchronizer::Sut::next_call() const {
  const Call* next = nullptr;
  for (const Call& call : calls)
    if (waits_for(call) &&
        (!next || std::pair(call.reply_at, call.id) < std::pair(next->reply_at, next->id)))
      next = &call;
  return next;
}

// After each change of a SUT.
void BarrierSynchronizer::update(SutIndex sut) {
  const Sut& s = suts_[sut];
  ExecTime limit = s.bound;
  for (const Call& call : s.calls) limit = std::min(limit, call.reply_at);
  const Call* const next = s.next_call();
  trees_->limit.set(sut, s.gone ? LeastTree::kNone : limit);
  trees_->reached.set(sut, s.gone ? LeastTree::kNone : s.bound);
  trees_->computing.set(sut, s.is_computing() ? s.bound : LeastTree::kNone);
  trees_->awaited.set(sut, next ? next->reply_at : LeastTree::kNone);
}

void BarrierSynchronizer::remove(SutIndex sut) {
  suts_[sut].gone = true;
  suts_[sut].calls.clear();
  update(sut);
}

void BarrierSynchronizer::progress(SutIndex sut, ExecTime reached) {
  Sut& s = suts_[sut];
  if (s.gone || reached <= s.bound || is_held(sut)) return;
  s.bound = reached;
  update(sut);
}

void BarrierSynchronizer::stop(SutIndex sut, ExecTime at, bool knows_moved) {
  Sut& s = suts_[sut];
  assert(!s.gone && !s.is_serial() && at >= s.bound);
  s.bound = s.stopped_at = at;
  if (knows_moved)
    for (Call& call : s.calls) call.is_moved = false;
  update(sut);
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
  update(sut);
  return arrival;
}

void BarrierSynchronizer::hold(const TimeAdvanceRequest& request) {
  Sut& s = suts_[request.sut];
  assert(s.is_computing() && request.reply_at >= s.bound && s.calls.size() < kMaxOpenCalls);
  s.calls.push_back({request.call, request.reply_at, request.lookahead});
  if (s.is_serial()) s.bound = request.reply_at;
  update(request.sut);
}

void BarrierSynchronizer::move_up(SutIndex sut, CallId call, ExecTime reply_at) {
  Sut& s = suts_[sut];
  const auto own = std::ranges::find(s.calls, call, &Call::id);
  assert(own != s.calls.end() && reply_at <= own->reply_at);
  own->reply_at = reply_at;
  own->is_moved = !s.is_serial();
  if (s.is_serial()) s.bound = reply_at;
  update(sut);
}

SimTime BarrierSynchronizer::lower_bound() const {
  const ExecTime least = trees_->limit.least();
  return least == LeastTree::kNone ? SimTime::max() : grid_.floor(same_instant(least));
}

std::optional<SutTime> BarrierSynchronizer::earliest() const {
  if (trees_->reached.least() == LeastTree::kNone) return std::nullopt;
  return SutTime{trees_->reached.least(), trees_->reached.first()};
}

// A command stamped t by another SUT acts at ceil(t). It must be in effect before the reply only if
// t < reply and ceil(t) ≤ st = floor(reply): impossible once that SUT's bound is beyond st, or is
// not before the reply itself. A concurrent SUT's own earlier commands have arrived once it has
// stopped. A message that another SUT sends at t arrives at t + lookahead or later, also within a
// step.
bool BarrierSynchronizer::may_resume(SutIndex sut, const Call& call, SimTime st,
                                     const std::optional<SutTime>& message) const {
  if (grid_.floor(same_instant(call.reply_at)) != st) return false;
  const ExecTime computing = trees_->computing.others(sut).least();
  if (same_instant(computing) <= st && computing < call.reply_at) return false;
  if (!call.lookahead) return true;
  if (message && *message <= SutTime{call.reply_at, sut}) return false;
  const auto [before, after] = trees_->reached.others(sut);
  const ExecTime least = call.reply_at - *call.lookahead;
  return before > least && after >= least;
}

std::optional<TimeAdvanceGrant> BarrierSynchronizer::release(
    SimTime st, const std::optional<SutTime>& message) {
  if (trees_->awaited.least() == LeastTree::kNone) return std::nullopt;
  const SutIndex sut = trees_->awaited.first();
  const Call next = *suts_[sut].next_call();
  if (!may_resume(sut, next, st, message)) return std::nullopt;
  std::erase_if(suts_[sut].calls, [&](const Call& call) { return call.id == next.id; });
  update(sut);
  return TimeAdvanceGrant{sut, next.reply_at, st, next.id};
}

bool BarrierSynchronizer::is_held(SutIndex sut) const {
  return suts_[sut].next_call() != nullptr;
}

}  // namespace tether::sync
