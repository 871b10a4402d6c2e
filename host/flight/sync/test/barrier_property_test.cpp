#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <tether/base/random.h>
#include <tether/sync/barrier_synchronizer.h>

// Random schedules of several SUTs against the barrier. The model below checks the rules of time
// (DESIGN section 2) from the order of events, and knows nothing of how the barrier decides.
namespace tether::sync {
namespace {

constexpr Duration kStep{1'000'000};
const StepGrid kGrid{kStep};

// One thread of a SUT: computes until `next_request`, then waits for its reply. A serial SUT has
// one.
struct Caller {
  enum class Kind { kCommand, kSample, kSleep };

  ExecTime next_request;  // where its computing will end
  bool held = false;      // its call is open …
  bool answered = false;  // … or has been answered, and it is stopped with the others
  CallId call = 0;
  ExecTime reply_at;
  Kind kind = Kind::kCommand;
  SimTime sampled_at;
  bool sampled = false;
};

struct Sut {
  bool concurrent = false;
  std::vector<Caller> callers;
  ExecTime known;  // what it has reported to the barrier
  CallId last_call = 0;
  std::pair<ExecTime, CallId> last_release{ExecTime::min(), 0};

  // Of a concurrent SUT.
  std::optional<ExecTime> stopped_at;        // where it is stopped, reported to the barrier or not
  std::deque<std::function<void()>> outbox;  // messages to be sent: requests, then the stop
};

class Schedule {
 public:
  Schedule(std::uint64_t seed, std::size_t serial, std::size_t concurrent)
      : random_({.seed = seed}), barrier_(kGrid) {
    for (std::size_t i = 0; i < serial + concurrent; ++i) {
      const bool is_concurrent = i >= serial;
      barrier_.add(ExecTime{}, is_concurrent ? SutKind::kConcurrent : SutKind::kSerial);
      Sut sut;
      sut.concurrent = is_concurrent;
      sut.callers.resize(is_concurrent ? 1 + random_.bits() % 5 : 1);
      for (Caller& caller : sut.callers) plan_next_request(caller, ExecTime{});
      suts_.push_back(std::move(sut));
    }
  }

  void run(std::uint64_t interactions) {
    while (interactions_ < interactions && !testing::Test::HasFatalFailure()) {
      const SutIndex i = random_.bits() % suts_.size();
      const std::uint32_t turn = random_.bits() % 4;
      Caller& first = suts_[i].callers[0];
      if (turn == 0 && suts_[i].concurrent) move_concurrent(i);
      if (turn == 0 && !suts_[i].concurrent && !first.held) request(i, first);
      if (turn == 1) maybe_progress(i);
      if (turn > 1) simulate(1 + random_.bits() % 5);
      release_all();
      check_held();
      if (++idle_ > 100'000) FAIL() << "no interaction ends any more: deadlock";
    }
  }

 private:
  // Up to so many steps later: on a step boundary, just before and just after one as often as
  // anywhere else.
  ExecTime random_time(ExecTime from, std::int64_t steps) {
    const ExecTime anywhere = from + Duration(random_.bits() % (steps * kStep.count() + 1));
    const ExecTime boundary = same_instant(kGrid.ceil(same_instant(anywhere)));
    const std::uint32_t kind = random_.bits() % 4;
    if (kind == 0) return boundary;
    if (kind == 1) return boundary + Duration(1);
    return kind == 2 ? std::max(from, boundary - Duration(1)) : anywhere;
  }

  void plan_next_request(Caller& caller, ExecTime from) {
    caller.next_request = random_time(from, random_.bits() % 9);
  }

  // One turn of a concurrent SUT: sends its next message; else continues if no reply is due, or
  // stops where it next has to.
  void move_concurrent(SutIndex i) {
    Sut& sut = suts_[i];
    if (!sut.outbox.empty()) {
      const auto send = std::move(sut.outbox.front());
      sut.outbox.pop_front();
      return send();
    }
    if (!sut.stopped_at) return stop(i);
    if (!waits(sut)) go_on(sut);
  }

  // The first thing for which it has to stop is a thread's request or a reply that is due; the stop
  // takes hold some time later, and by then other threads may have got to a request too.
  void stop(SutIndex i) {
    Sut& sut = suts_[i];
    ExecTime at = ExecTime::max();
    for (const Caller& c : sut.callers) at = std::min(at, c.held ? c.reply_at : c.next_request);
    if (random_.bits() % 2) at = random_time(at, 2);
    sut.stopped_at = at;

    std::vector<Caller*> asking;
    for (Caller& c : sut.callers)
      if (!c.held && c.next_request <= at) asking.push_back(&c);
    std::stable_sort(asking.begin(), asking.end(), [](const Caller* a, const Caller* b) {
      return a->next_request < b->next_request;
    });
    for (Caller* c : asking) sut.outbox.push_back([this, i, c] { request(i, *c); });
    sut.outbox.push_back([this, i, at] {
      suts_[i].known = at;
      barrier_.stop(i, at);
    });
  }

  static bool waits(const Sut& sut) {
    return std::any_of(sut.callers.begin(), sut.callers.end(),
                       [&](const Caller& c) { return c.held && c.reply_at <= *sut.stopped_at; });
  }

  void go_on(Sut& sut) {
    for (Caller& c : sut.callers) {
      if (c.answered) plan_next_request(c, *sut.stopped_at);
      c.answered = false;
    }
    sut.stopped_at.reset();
  }

  void request(SutIndex i, Caller& caller) {
    const ExecTime t = caller.next_request;
    // Rule 4: nothing that is still requested lies in the simulator's past.
    ASSERT_LE(st_, kGrid.floor(same_instant(t)));
    const Arrival arrival = barrier_.arrive(i, t, st_);
    ASSERT_FALSE(arrival.violation);
    ASSERT_EQ(arrival.charged_at, t);
    ASSERT_EQ(arrival.lag, lag(t, st_));

    caller.kind = static_cast<Caller::Kind>(random_.bits() % 3);
    caller.reply_at = t;
    if (caller.kind == Caller::Kind::kCommand) {
      issue_command(t);
    } else if (caller.kind == Caller::Kind::kSample) {
      caller.sampled_at = same_instant(t);
      caller.sampled = false;
      caller.reply_at = random_time(t, 20);
    } else {
      caller.reply_at = random_time(t, 40);
    }
    caller.held = true;
    caller.call = ++suts_[i].last_call;
    suts_[i].known = t;
    barrier_.hold({i, caller.reply_at, caller.call});
    sample_due();
    apply_due();
  }

  void issue_command(ExecTime t) {
    const ExecTime acts = random_.bits() % 2 ? t : random_time(t, 3);
    const SimTime effect = kGrid.ceil(same_instant(acts));
    // Rule 2: there is still time to act exactly at the boundary.
    ASSERT_GE(effect, st_);
    // Rule 3, seen from the command: no reply stamped later has left at or after the boundary on
    // which it acts.
    ASSERT_FALSE(effect == st_ && last_release_here_ > t)
        << "a later reply left before this command was in effect";
    pending_commands_.emplace(effect, t);
  }

  // A progress may say anything up to where the SUT next has to stop.
  void maybe_progress(SutIndex i) {
    Sut& sut = suts_[i];
    if (sut.stopped_at || (!sut.concurrent && sut.callers[0].held)) return;
    ExecTime end = ExecTime::max();
    for (const Caller& c : sut.callers) end = std::min(end, c.held ? c.reply_at : c.next_request);
    const Duration left = end - sut.known;
    sut.known += Duration(
        static_cast<std::int64_t>(random_.uniform() * static_cast<double>(left.count() + 1)));
    barrier_.progress(i, sut.known);
  }

  void simulate(std::int64_t steps) {
    for (; steps > 0 && st_ + kStep <= barrier_.lower_bound(); --steps) {
      ASSERT_TRUE(pending_commands_.empty() || pending_commands_.begin()->first > st_);
      st_ += kStep;
      last_release_here_ = ExecTime::min();
      // Rule 4: no computing caller will stamp anything before ST, and no held one resumes before
      // it.
      for (const Sut& sut : suts_)
        for (const Caller& c : sut.callers)
          ASSERT_LE(st_, same_instant(c.answered ? *sut.stopped_at
                                      : c.held   ? c.reply_at
                                                 : c.next_request));
      apply_due();
      sample_due();
      if (random_.bits() % 2) release_all();
    }
  }

  void apply_due() {
    while (!pending_commands_.empty() && pending_commands_.begin()->first <= st_) {
      ASSERT_EQ(pending_commands_.begin()->first,
                st_);  // rule 2: neither before nor after its boundary
      pending_commands_.erase(pending_commands_.begin());
    }
  }

  void sample_due() {
    for (Sut& sut : suts_) {
      for (Caller& c : sut.callers) {
        if (!c.held || c.kind != Caller::Kind::kSample || c.sampled) continue;
        ASSERT_GE(kGrid.floor(c.sampled_at), st_);
        c.sampled = kGrid.floor(c.sampled_at) == st_;
      }
    }
  }

  void release_all() {
    while (const auto grant = barrier_.release(st_)) {
      Sut& sut = suts_[grant->sut];
      const auto caller =
          std::find_if(sut.callers.begin(), sut.callers.end(),
                       [&](const Caller& c) { return c.held && c.call == grant->call; });
      ASSERT_NE(caller, sut.callers.end());
      check_grant(*grant, sut, *caller);
      last_release_here_ = std::max(last_release_here_, caller->reply_at);
      caller->held = false;
      if (sut.concurrent) {
        caller->answered = true;
      } else {
        sut.known = caller->reply_at;
        plan_next_request(*caller, caller->reply_at);
      }
      ++interactions_;
      idle_ = 0;
    }
  }

  void check_grant(const TimeAdvanceGrant& grant, Sut& sut, const Caller& caller) {
    ASSERT_EQ(grant.resume_at, caller.reply_at);  // rule 5
    ASSERT_EQ(grant.released_at, st_);
    ASSERT_EQ(st_, kGrid.floor(same_instant(caller.reply_at)));  // rule 3
    if (caller.kind == Caller::Kind::kSample) {
      ASSERT_TRUE(caller.sampled);                                  // rule 1: there is data …
      ASSERT_LE(caller.sampled_at, same_instant(caller.reply_at));  // … and not from the future
    }
    // Rule 3: every earlier command that can act by now is in effect.
    for (const auto& [effect, stamp] : pending_commands_)
      ASSERT_FALSE(stamp < caller.reply_at && effect <= st_);
    if (!sut.concurrent) return;
    // Rule 5, concurrent: it is stopped, at the reply's timestamp or after it.
    ASSERT_TRUE(sut.stopped_at && sut.outbox.empty());
    ASSERT_GE(*sut.stopped_at, caller.reply_at);
    // Its replies leave in an order that does not depend on how ST and messages met.
    const std::pair order(caller.reply_at, caller.call);
    ASSERT_LT(sut.last_release, order);
    sut.last_release = order;
  }

  void check_held() {
    for (SutIndex i = 0; i < suts_.size(); ++i) {
      const Sut& sut = suts_[i];
      const bool held = !sut.concurrent ? sut.callers[0].held
                                        : sut.stopped_at && sut.outbox.empty() && waits(sut);
      ASSERT_EQ(barrier_.is_held(i), held);
    }
  }

  KeyedRandom random_;
  BarrierSynchronizer barrier_;
  std::vector<Sut> suts_;
  std::multimap<SimTime, ExecTime> pending_commands_;  // effect → stamp
  SimTime st_{};
  ExecTime last_release_here_ =
      ExecTime::min();  // greatest reply stamp that left at the present ST
  std::uint64_t interactions_ = 0;
  std::uint64_t idle_ = 0;
};

/// Numbers of serial and of concurrent SUTs.
class BarrierProperty : public testing::TestWithParam<std::pair<std::size_t, std::size_t>> {};

constexpr std::uint64_t kDecisions = 5'000;  // of each schedule

// Schedules of each mixture; bench/soak asks for more.
std::uint64_t schedules() {
  const char* given = std::getenv("TETHER_SCHEDULES");
  return given ? std::stoull(given) : 20;
}

TEST_P(BarrierProperty, RulesOneToFiveHoldForAnySchedule) {
  for (std::uint64_t seed = 0; seed < schedules(); ++seed) {
    SCOPED_TRACE(seed);
    Schedule(seed, GetParam().first, GetParam().second).run(kDecisions);
    if (HasFatalFailure()) return;
  }
}

INSTANTIATE_TEST_SUITE_P(Mixtures, BarrierProperty,
                         testing::Values(std::pair(1, 0), std::pair(2, 0), std::pair(3, 0),
                                         std::pair(7, 0), std::pair(0, 1), std::pair(0, 3),
                                         std::pair(1, 1), std::pair(3, 1), std::pair(2, 3)));

}  // namespace
}  // namespace tether::sync
