#include "sensors/sampler.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include <tether/base/error.h>
#include <tether/base/random.h>

namespace tether::coordinator {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

SimTime st_us(std::int64_t value) {
  return SimTime(microseconds(value));
}

/// A sampler of one sensor, over a simulator whose state is its instant.
class Sampling : public testing::Test {
 protected:
  void make(const uav::SensorTiming& timing, std::uint64_t seed = 0) {
    make(SensorSchedule(timing, seed, 0));
  }
  void make(SensorSchedule schedule) {
    sampler_.emplace(std::vector<Sampler::Sensor>{{"sensor", std::move(schedule)}}, kGrid);
  }
  void sample(SimTime st, SimTime earliest) {
    sampler_->sample(st, earliest, [&] {
      ++captures_;
      return std::make_shared<sim::Snapshot>(sim::Snapshot{.at = st, .state = {}});
    });
  }
  static constexpr StepGrid kGrid{milliseconds(1)};
  std::optional<Sampler> sampler_;
  int captures_ = 0;
};

const uav::OnDemandTiming kOnDemand{uav::ConstantDelay{milliseconds(20)}};
const uav::PeriodicTiming kPeriodic{milliseconds(10), Duration(0),
                                    uav::ConstantDelay{milliseconds(25)}};

TEST_F(Sampling, CapturesAnOnDemandReadOnceAtTheBoundaryOfItsRequest) {
  make(kOnDemand);
  EXPECT_EQ(sampler_->next_due(), SimTime::max());
  ASSERT_TRUE(sampler_->plan(7, {}, st_us(2'300)));
  EXPECT_EQ(sampler_->next_due(), st_us(2'000));
  sample(st_us(1'000), st_us(0));
  EXPECT_EQ(captures_, 0);
  EXPECT_THROW(sampler_->state_of(*sampler_->find(7)), Error);
  sample(st_us(2'000), st_us(0));
  sample(st_us(3'000), st_us(0));
  EXPECT_EQ(captures_, 1);
  EXPECT_EQ(sampler_->state_of(*sampler_->find(7)).at, st_us(2'000));
  EXPECT_EQ(sampler_->next_due(), SimTime::max());
  sampler_->answered(7, st_us(0));
  EXPECT_EQ(sampler_->find(7), nullptr);
}

TEST_F(Sampling, CapturesPeriodicSensorsUnlessInFreeRunning) {
  make(kPeriodic);
  EXPECT_EQ(sampler_->next_due(), st_us(0));
  sample(st_us(0), st_us(0));
  EXPECT_EQ(sampler_->next_due(), st_us(10'000));
  make(SensorSchedule::in_free_running(kPeriodic));
  EXPECT_EQ(sampler_->next_due(), SimTime::max());
}

TEST_F(Sampling, NothingIsDueOnceTheSutHasLeft) {
  make(kPeriodic);
  ASSERT_TRUE(sampler_->plan(1, {}, st_us(0)));
  sampler_->close();
  EXPECT_EQ(sampler_->next_due(), SimTime::max());
  sample(st_us(50'000), st_us(0));
  EXPECT_EQ(captures_, 0);
}

// Delays of several periods reorder what becomes available, several reads are open at once, and ST
// is behind the timestamps of requests. The state of each read is kept until its reply, and is that
// of the sampling instant.
TEST_F(Sampling, NoStateIsDroppedBeforeItIsRead) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    SCOPED_TRACE(seed);
    make(uav::PeriodicTiming{milliseconds(5), Duration(0),
                             uav::NormalDelay{milliseconds(8), milliseconds(9)}},
         seed);
    KeyedRandom random({.seed = seed});
    std::vector<std::pair<std::uint64_t, SimTime>> open;
    SimTime st{}, stamp{};
    for (std::uint64_t call = 1; call <= 300; ++call) {
      stamp += microseconds(random.bits() % 9'000);
      const auto read = sampler_->plan(call, {0, random.bits() % 2 == 0}, stamp);
      open.emplace_back(call, std::max(stamp, read->available_at));
      const SimTime until = kGrid.floor(stamp);
      while ((st = std::min(until, sampler_->next_due())) < until) sample(st, stamp);
      sample(st, stamp);
      std::erase_if(open, [&](const auto& due) {
        if (due.second > st) return false;
        const Sampler::Read& answered = *sampler_->find(due.first);
        EXPECT_EQ(sampler_->state_of(answered).at, kGrid.floor(answered.measurement.sampled_at));
        sampler_->answered(due.first, due.second);
        return true;
      });
    }
    EXPECT_LT(open.size(), 20u);
  }
}

// A read twice if it was forecast, and after nine reads the next one.
TEST_F(Sampling, AnnouncesWhatWillBeRead) {
  for (const bool is_drawn : {true, false}) {
    sampler_.emplace(
        std::vector<Sampler::Sensor>{
            {.name = "sensor", .schedule = {kPeriodic, 0, 0}, .is_drawn = is_drawn}},
        kGrid);
    std::vector<std::uint64_t> announced;
    const auto announce = [&] {
      for (int i = 0; i < 2; ++i)
        sampler_->announce([&](const sim::Snapshot& state, std::size_t, std::uint64_t index) {
          EXPECT_EQ(state.at, uav::sampling_instant(kPeriodic, index));
          announced.push_back(index);
        });
    };
    SimTime st{}, t{};
    for (std::uint64_t call = 1; call <= 11; ++call) {
      const SimTime reply_at = sampler_->plan(call, {0, false}, t)->available_at;
      for (; st <= reply_at; st += milliseconds(1)) sample(st, t);
      announce();
      sampler_->answered(call, reply_at);
      announce();
      t = reply_at + milliseconds(5);
    }
    EXPECT_EQ(announced,
              is_drawn ? std::vector<std::uint64_t>({0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 9, 10, 10, 11})
                       : std::vector<std::uint64_t>{});
    sampler_->close();
    announce();
    EXPECT_EQ(announced.size(), is_drawn ? 14u : 0u);
  }
}

}  // namespace
}  // namespace tether::coordinator
