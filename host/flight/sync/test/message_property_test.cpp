#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include <tether/base/random.h>
#include <tether/sync/barrier_synchronizer.h>

// SUTs that send each other messages, against the barrier. What each SUT receives, and when, must
// not depend on the wall time at which requests arrive.
namespace tether::sync {
namespace {

constexpr Duration kMillisecond{1'000'000};
const StepGrid kMilliseconds{kMillisecond};

/// In the order of the draws; times collide often.
ExecTime later(ExecTime from, KeyedRandom& random) {
  const Duration choices[] = {Duration(0), Duration(1), Duration(300'000), kMillisecond,
                              Duration(2'300'000)};
  return from + choices[random.bits() % 5];
}

struct Program {
  explicit Program(std::uint64_t seed, SutIndex sut) : random({.seed = seed, .stream = sut}) {}
  KeyedRandom random;  // of the program only: its choices do not depend on the schedule
  ExecTime at;
  bool held = false;
  bool receives = false;
  ExecTime timeout;
  std::uint64_t sequence = 0;
  std::vector<std::string> heard;
};

class Radio {
 public:
  Radio(std::uint64_t programs, std::uint64_t schedule, Duration delay, std::size_t suts)
      : delay_(delay), schedule_({.seed = schedule, .stream = 99}) {
    for (SutIndex i = 0; i < suts; ++i) {
      programs_.emplace_back(programs, i);
      barrier_.add(ExecTime{});
      inbox_.emplace_back();
    }
  }

  std::vector<std::vector<std::string>> run(int requests) {
    for (int idle = 0; requests > 0 && idle < 10'000; ++idle) {
      const SutIndex i = schedule_.bits() % programs_.size();
      if (!programs_[i].held) {
        request(i);
        --requests;
        idle = 0;
      }
      settle();
      const SimTime next = st_ + kMillisecond;
      if (next <= barrier_.lower_bound() && (!message() || same_instant(message()->at) >= next))
        st_ = next;
      settle();
    }
    EXPECT_EQ(requests, 0) << "deadlock";
    std::vector<std::vector<std::string>> heard;
    for (Program& program : programs_) heard.push_back(program.heard);
    return heard;
  }

 private:
  void request(SutIndex i) {
    Program& own = programs_[i];
    own.at = later(own.at, own.random);
    barrier_.arrive(i, own.at, st_);
    own.held = true;
    own.receives = own.random.bits() % 2 == 0;
    own.timeout = own.receives ? later(own.at, own.random) : own.at;
    ++own.sequence;
    if (!own.receives && own.random.bits() % 2 == 0) {
      transit_.insert({own.at + delay_, i, own.sequence});
    } else if (!own.receives) {
      own.timeout = later(own.at, own.random);  // it sleeps
    }
    barrier_.hold(
        {i, own.timeout, own.sequence, own.receives ? std::optional(delay_) : std::nullopt});
    if (own.receives && !inbox_[i].empty()) barrier_.move_up(i, own.sequence, own.at);
  }

  std::optional<SutTime> message() const {
    if (transit_.empty()) return std::nullopt;
    return SutTime{std::get<0>(*transit_.begin()), std::get<1>(*transit_.begin())};
  }

  void settle() {
    while (deliver_one() || release_one()) {
    }
  }

  bool deliver_one() {
    if (!message() || *message() > *barrier_.earliest()) return false;
    if (kMilliseconds.floor(same_instant(message()->at)) > st_) return false;
    const auto [at, sender, number] = *transit_.begin();
    transit_.erase(transit_.begin());
    for (SutIndex i = 0; i < programs_.size(); ++i) {
      Program& own = programs_[i];
      if (i == sender) continue;
      if (own.held && own.receives && inbox_[i].empty() && at <= own.timeout)
        barrier_.move_up(i, own.sequence, std::max(at, own.at));
      inbox_[i].push_back(std::to_string(to_ns(at)) + " from " + std::to_string(sender) + " #" +
                          std::to_string(number));
      arrived_[i].insert(at);
    }
    return true;
  }

  bool release_one() {
    const auto grant = barrier_.release(st_, message());
    if (!grant) return false;
    Program& own = programs_[grant->sut];
    own.held = false;
    own.at = grant->resume_at;
    if (!own.receives) return true;
    auto& inbox = inbox_[grant->sut];
    own.heard.push_back(std::to_string(to_ns(own.at)) + ": " +
                        (inbox.empty() ? "nothing" : inbox.front()));
    if (!inbox.empty()) inbox.erase(inbox.begin());
    return true;
  }

  Duration delay_;
  KeyedRandom schedule_;
  BarrierSynchronizer barrier_{kMilliseconds};
  std::vector<Program> programs_;
  std::vector<std::vector<std::string>> inbox_;
  std::map<SutIndex, std::multiset<ExecTime>> arrived_;
  std::set<std::tuple<ExecTime, SutIndex, std::uint64_t>> transit_;
  SimTime st_;
};

TEST(Messages, ArriveTheSameInEverySchedule) {
  for (const Duration delay : {Duration(0), Duration(1), Duration(400'000), 3 * kMillisecond}) {
    for (std::uint64_t programs = 1; programs <= 40; ++programs) {
      const std::size_t suts = 2 + programs % 4;
      const auto heard = Radio(programs, 1, delay, suts).run(300);
      for (std::uint64_t schedule = 2; schedule <= 5; ++schedule) {
        const auto other = Radio(programs, schedule, delay, suts).run(300);
        for (SutIndex i = 0; i < suts; ++i) {
          // The last of them are cut off at different places.
          const std::size_t both = std::min(heard[i].size(), other[i].size());
          for (std::size_t k = 0; k < both; ++k)
            ASSERT_EQ(heard[i][k], other[i][k])
                << "SUT " << i << ", delay " << delay.count() << " ns, programs " << programs;
        }
      }
    }
  }
}

TEST(Messages, AReceiveIsReleasedAtItsTimeoutOnceNoEarlierMessageCanBeSent) {
  struct Case {
    Duration lookahead;
    std::int64_t other_ns;
    bool is_released;
  };
  // A receive of SUT 1 until 1.5 ms; SUT 0 computes and has reached `other_ns`.
  for (const Case& c :
       {Case{Duration(0), 1'400'000, false}, Case{Duration(0), 1'500'000, false},
        Case{Duration(0), 1'500'001, true}, Case{Duration(200'000), 1'300'000, false},
        Case{Duration(200'000), 1'300'001, true}, Case{2 * kMillisecond, 1'000'001, true}}) {
    BarrierSynchronizer barrier(kMilliseconds);
    barrier.add(ExecTime{});
    barrier.add(ExecTime{});
    barrier.arrive(1, ExecTime{}, SimTime{});
    barrier.hold({1, ExecTime(Duration(1'500'000)), 1, c.lookahead});
    barrier.progress(0, ExecTime(Duration(c.other_ns)));
    EXPECT_EQ(barrier.release(SimTime(kMillisecond)).has_value(), c.is_released)
        << c.lookahead.count() << " " << c.other_ns;
  }
}

TEST(Messages, AConcurrentSutReceivesAMessageOnceItHasStoppedForIt) {
  BarrierSynchronizer barrier(kMilliseconds);
  const SutIndex receiver = barrier.add(ExecTime{}, SutKind::kConcurrent);
  barrier.add(from_ns<ExecTime>(5'000'000));
  barrier.arrive(receiver, ExecTime{}, SimTime{});
  barrier.hold({receiver, from_ns<ExecTime>(4'000'000), 7, Duration(0)});
  barrier.stop(receiver, from_ns<ExecTime>(300'000));
  barrier.move_up(receiver, 7, from_ns<ExecTime>(200'000));
  EXPECT_FALSE(barrier.release(SimTime{})) << "it went on when its request was known";
  barrier.stop(receiver, from_ns<ExecTime>(400'000), false);
  EXPECT_FALSE(barrier.release(SimTime{})) << "it stopped for something else";
  barrier.stop(receiver, from_ns<ExecTime>(400'000), true);
  const auto grant = barrier.release(SimTime{});
  ASSERT_TRUE(grant);
  EXPECT_EQ(grant->resume_at, from_ns<ExecTime>(200'000));
}

}  // namespace
}  // namespace tether::sync
