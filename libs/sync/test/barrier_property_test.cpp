#include <algorithm>
#include <map>
#include <vector>

#include <gtest/gtest.h>

#include <tether/base/random.h>
#include <tether/sync/barrier_synchronizer.h>

// Random schedules of several SUTs against the barrier, judged from outside: the model below knows
// the rules of time (DESIGN section 2) and the order in which things really happened, and nothing
// of how the barrier decides.
namespace tether::sync {
namespace {

constexpr Duration kStep{1'000'000};
const StepGrid kGrid{kStep};

class Schedule {
 public:
  Schedule(std::uint64_t seed, std::size_t sut_count) : random_({.seed = seed}), barrier_(kGrid) {
    for (std::size_t i = 0; i < sut_count; ++i) {
      barrier_.add(ExecTime{});
      suts_.push_back({});
      plan_next_request(suts_.back());
    }
  }

  void run(std::uint64_t interactions) {
    while (interactions_ < interactions && !testing::Test::HasFatalFailure()) {
      switch (random_.bits() % 4) {
        case 0:
          maybe_request();
          break;
        case 1:
          maybe_progress();
          break;
        default:
          simulate(1 + random_.bits() % 5);
          break;
      }
      release_all();
      if (++idle_ > 100'000) FAIL() << "no interaction ends any more: deadlock";
    }
  }

 private:
  enum class Kind { kCommand, kSample, kSleep };
  struct Sut {
    ExecTime et;            // what the SUT itself believes
    ExecTime next_request;  // where its computing will end
    ExecTime known;         // what it has told the barrier
    bool held = false;
    ExecTime reply_at;
    Kind kind = Kind::kCommand;
    SimTime sampled_at;
    bool sampled = false;
  };

  // Times that fall on, just before and just after step boundaries as often as anywhere else.
  Duration random_duration(std::int64_t steps) {
    const Duration whole = kStep * static_cast<std::int64_t>(random_.bits() % (steps + 1));
    switch (random_.bits() % 4) {
      case 0:
        return whole;
      case 1:
        return whole + Duration(1);
      case 2:
        return std::max(Duration(0), whole - Duration(1));
      default:
        return whole + Duration(random_.bits() % kStep.count());
    }
  }

  void plan_next_request(Sut& sut) { sut.next_request = sut.et + random_duration(8); }

  void maybe_request() {
    const SutIndex i = random_.bits() % suts_.size();
    Sut& sut = suts_[i];
    if (sut.held) return;
    const ExecTime t = sut.next_request;

    // Rule 4: nothing that is still requested lies in the simulator's past.
    ASSERT_LE(st_, kGrid.floor(same_instant(t)));
    const Arrival arrival = barrier_.arrive(i, t, st_);
    ASSERT_FALSE(arrival.violation);
    ASSERT_EQ(arrival.charged_at, t);
    ASSERT_EQ(arrival.lag, lag(t, st_));

    sut.kind = static_cast<Kind>(random_.bits() % 3);
    sut.reply_at = t;
    if (sut.kind == Kind::kCommand) {
      issue_command(t);
    } else if (sut.kind == Kind::kSample) {
      sut.sampled_at = same_instant(t);
      sut.sampled = false;
      sut.reply_at = t + random_duration(20);
    } else {
      sut.reply_at = t + random_duration(40);
    }
    sut.held = true;
    barrier_.hold({i, sut.reply_at});
    sample_due();
    apply_due();
  }

  void issue_command(ExecTime t) {
    const Duration latency = random_.bits() % 2 ? Duration(0) : random_duration(3);
    const SimTime effect = kGrid.ceil(same_instant(t) + latency);
    // Rule 2: there is still time to act exactly at the boundary.
    ASSERT_GE(effect, st_);
    // Rule 3, seen from the command: no reply stamped later has left at or after the boundary on
    // which it acts.
    ASSERT_FALSE(effect == st_ && last_release_here_ > t)
        << "a later reply left before this command was in effect";
    pending_commands_.emplace(effect, t);
  }

  void maybe_progress() {
    const SutIndex i = random_.bits() % suts_.size();
    Sut& sut = suts_[i];
    if (sut.held) return;
    const Duration left = sut.next_request - sut.known;
    sut.known += Duration(
        static_cast<std::int64_t>(random_.uniform() * static_cast<double>(left.count() + 1)));
    barrier_.progress(i, sut.known);
  }

  void simulate(std::int64_t steps) {
    for (; steps > 0 && st_ + kStep <= barrier_.horizon(); --steps) {
      ASSERT_TRUE(pending_commands_.empty() || pending_commands_.begin()->first > st_);
      st_ += kStep;
      last_release_here_ = ExecTime::min();
      // Rule 4 from outside: no computing SUT will stamp anything before ST, and no held one
      // resumes before it.
      for (const Sut& sut : suts_)
        ASSERT_LE(st_, same_instant(sut.held ? sut.reply_at : sut.next_request));
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
      if (!sut.held || sut.kind != Kind::kSample || sut.sampled) continue;
      ASSERT_GE(kGrid.floor(sut.sampled_at), st_);
      sut.sampled = kGrid.floor(sut.sampled_at) == st_;
    }
  }

  void release_all() {
    while (const auto grant = barrier_.release(st_)) {
      Sut& sut = suts_[grant->sut];
      ASSERT_TRUE(sut.held);
      ASSERT_EQ(grant->resume_at, sut.reply_at);  // rule 5
      ASSERT_EQ(grant->released_at, st_);
      ASSERT_EQ(st_, kGrid.floor(same_instant(sut.reply_at)));  // rule 3
      if (sut.kind == Kind::kSample) {
        ASSERT_TRUE(sut.sampled);                               // rule 1: there is data …
        ASSERT_LE(sut.sampled_at, same_instant(sut.reply_at));  // … and it is not from the future
      }
      // Rule 3: every earlier command that can act by now is in effect.
      for (const auto& [effect, stamp] : pending_commands_)
        ASSERT_FALSE(stamp < sut.reply_at && effect <= st_);
      last_release_here_ = std::max(last_release_here_, sut.reply_at);
      sut.et = sut.known = sut.reply_at;
      sut.held = false;
      plan_next_request(sut);
      ++interactions_;
      idle_ = 0;
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

class BarrierProperty : public testing::TestWithParam<std::size_t> {};

TEST_P(BarrierProperty, RulesOneToFiveHoldForAnySchedule) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    Schedule(seed, GetParam()).run(5'000);
    if (HasFatalFailure()) return;
  }
}

INSTANTIATE_TEST_SUITE_P(Suts, BarrierProperty, testing::Values(1, 2, 3, 7));

}  // namespace
}  // namespace tether::sync
