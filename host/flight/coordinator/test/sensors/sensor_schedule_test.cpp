#include "sensors/sensor_schedule.h"

#include <algorithm>
#include <limits>
#include <set>

#include <gtest/gtest.h>

namespace tether::coordinator {
namespace {

using std::chrono::milliseconds;
SimTime ms(std::int64_t value) {
  return SimTime(milliseconds(value));
}

uav::PeriodicTiming every_33_ms(Duration delay, Duration phase = Duration(0)) {
  return {milliseconds(33), phase, uav::ConstantDelay{delay}};
}
SensorSchedule camera(Duration delay, Duration phase = Duration(0)) {
  return {every_33_ms(delay, phase), 0, 0};
}

struct PeriodicCase {
  const char* what;
  std::int64_t read_ms;
  bool latest;
  Measurement expected;
};

// Period 33 ms, delay 10 ms; measurement 1 (available at 43 ms) has been read.
TEST(SensorSchedule, PeriodicReads) {
  SensorSchedule schedule = camera(milliseconds(10));
  schedule.mark_read({1, ms(33), ms(43)});
  const PeriodicCase cases[] = {
      {"nothing new: waits for the next", 44, false, {2, ms(66), ms(76)}},
      {"the next is sampled but not yet available", 70, false, {2, ms(66), ms(76)}},
      {"the next is available", 76, false, {2, ms(66), ms(76)}},
      {"the newest is taken, the one between is skipped", 150, false, {4, ms(132), ms(142)}},
      {"latest: the last one again", 70, true, {1, ms(33), ms(43)}},
      {"latest: a newer one if there is one", 80, true, {2, ms(66), ms(76)}},
  };
  for (const auto& c : cases)
    EXPECT_EQ(schedule.choose(ms(c.read_ms), c.latest), c.expected) << c.what;
}

TEST(SensorSchedule, OnDemandMeasuresAtTheRequestAndDeliversADelayLater) {
  SensorSchedule schedule(uav::OnDemandTiming{uav::ConstantDelay{milliseconds(98)}}, 0, 0);
  const auto t = from_ns<SimTime>(1'234'567);
  const Measurement first = schedule.choose(t, false);
  EXPECT_EQ(first, (Measurement{0, t, t + milliseconds(98)}));
  schedule.mark_read(first);
  EXPECT_EQ(schedule.choose(t, false).index, 1u);
  EXPECT_FALSE(schedule.sampling_instant(0));
}

// Free running: measurement 1 (of 33 ms) has been read.
TEST(SensorSchedule, FreeRunningReadsGetTheStateAtOnceOncePerPeriod) {
  SensorSchedule schedule = SensorSchedule::in_free_running(every_33_ms(milliseconds(10)));
  EXPECT_TRUE(schedule.is_periodic());
  EXPECT_FALSE(schedule.sampling_instant(0)) << "its samples are of the reads";
  schedule.mark_read({1, ms(40), ms(40)});
  const PeriodicCase cases[] = {
      {"that of the period was read: waits for the next", 44, false, {2, ms(66), ms(66)}},
      {"latest: now, again", 44, true, {1, ms(44), ms(44)}},
      {"a new period: now", 70, false, {2, ms(70), ms(70)}},
      {"periods that passed by are not read later", 150, false, {4, ms(150), ms(150)}},
  };
  for (const auto& c : cases)
    EXPECT_EQ(schedule.choose(ms(c.read_ms), c.latest), c.expected) << c.what;
  const auto late = SensorSchedule::in_free_running(every_33_ms(Duration(0), milliseconds(5)));
  EXPECT_EQ(late.choose(ms(0), true), (Measurement{0, ms(5), ms(5)})) << "before the phase";
  const auto on_demand =
      SensorSchedule::in_free_running(uav::OnDemandTiming{uav::ConstantDelay{milliseconds(98)}});
  EXPECT_EQ(on_demand.choose(ms(7), false), (Measurement{0, ms(7), ms(7)}));
}

// Measurements 2 and 3 passed by, of which a queue of 2 has one.
TEST(SensorSchedule, CountsWhatHadNoPlaceInAQueue) {
  SensorSchedule free = SensorSchedule::in_free_running(every_33_ms(milliseconds(10)));
  const Measurement later{4, ms(150), ms(150)};
  EXPECT_EQ(free.unqueued(later, 9), 0u) << "it fills from the first read on";
  free.mark_read({1, ms(40), ms(40)});
  EXPECT_EQ(free.unqueued(later, 9), 2u);
  EXPECT_EQ(free.unqueued(later, 2), 1u);
  EXPECT_EQ(free.unqueued(later, 1), 0u) << "no queue";
  SensorSchedule synchronised = camera(milliseconds(10));
  synchronised.mark_read({1, ms(33), ms(43)});
  EXPECT_EQ(synchronised.unqueued(later, 2), 2u) << "they had no place";
  EXPECT_EQ(synchronised.unqueued(later, 1), 0u) << "no queue";
}

// Synchronised and in free running; measurement 1 (of 33 ms, available at 43 ms) has been read.
TEST(SensorSchedule, ReadsIfAvailableDoNotWait) {
  SensorSchedule schedule = camera(milliseconds(10));
  schedule.mark_read({1, ms(33), ms(43)});
  EXPECT_FALSE(schedule.choose_available(ms(75), false));
  EXPECT_EQ(schedule.choose_available(ms(75), true), (Measurement{1, ms(33), ms(43)}));
  EXPECT_EQ(schedule.choose_available(ms(76), false), (Measurement{2, ms(66), ms(76)}));
  SensorSchedule free = SensorSchedule::in_free_running(every_33_ms(milliseconds(10)));
  free.mark_read({1, ms(33), ms(43)});
  EXPECT_FALSE(free.choose_available(ms(65), false));
  EXPECT_EQ(free.choose_available(ms(65), true), (Measurement{1, ms(65), ms(65)}));
  EXPECT_EQ(free.choose_available(ms(66), false), (Measurement{2, ms(66), ms(66)}));
  EXPECT_FALSE(camera(Duration(0), milliseconds(5)).choose_available(ms(4), true));
}

// Against the definition, by trying every measurement: random delays up to several periods reorder
// what becomes available.
TEST(SensorSchedule, AgreesWithTheDefinitionUnderRandomDelays) {
  const uav::PeriodicTiming timing{Duration(100), Duration(17),
                                   uav::NormalDelay{Duration(150), Duration(120)}};
  KeyedRandom random({.seed = 5});
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    SensorSchedule schedule(timing, seed, 9);
    std::vector<SimTime> available;
    for (std::uint64_t k = 0; k < 800; ++k)
      available.push_back(uav::sampling_instant(timing, k) + uav::draw(timing.delay, {seed, 9, k}));
    std::uint64_t unread = 0;
    std::int64_t now = 0;
    for (int i = 0; i < 200; ++i) {
      now += random.bits() % 300;
      const auto t = from_ns<SimTime>(now);
      const bool latest = random.bits() % 4 == 0;

      std::optional<std::uint64_t> newest, next;
      for (std::uint64_t k = 0; k < available.size(); ++k) {
        if (available[k] <= t && (latest || k >= unread)) newest = k;
        if (k >= unread && (!next || available[k] < available[*next])) next = k;
      }
      const std::uint64_t expected = newest.value_or(*next);
      const Measurement got = schedule.choose(t, latest);
      ASSERT_EQ(got.index, expected) << "seed " << seed << ", read " << i;
      ASSERT_EQ(got.available_at, available.at(expected));
      ASSERT_GE(got.index, schedule.first_readable(t));
      schedule.mark_read(got);
      unread = std::max(unread, got.index + 1);
      now = std::max(now, to_ns(got.available_at));
    }
  }
}

// Against the definition: of the newest `queue` before the first unread one that has not arrived,
// the oldest that was not read.
TEST(SensorSchedule, AQueueAgreesWithItsDefinitionUnderRandomDelays) {
  const uav::PeriodicTiming timing{Duration(100), Duration(17),
                                   uav::NormalDelay{Duration(150), Duration(120)}};
  KeyedRandom random({.seed = 6});
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    SensorSchedule schedule(timing, seed, 9);
    std::vector<SimTime> available;
    for (std::uint64_t k = 0; k < 900; ++k)
      available.push_back(uav::sampling_instant(timing, k) + uav::draw(timing.delay, {seed, 9, k}));
    const std::uint32_t queue = 2 + random.bits() % 6;
    std::uint64_t unread = 0, begun_at = 0, readable = 0;
    std::int64_t now = 0;
    for (int i = 0; i < 200; ++i) {
      now += random.bits() % 300;
      const auto t = from_ns<SimTime>(now);
      ASSERT_GE(schedule.first_readable(t), readable) << "what was dropped is not read later";
      schedule.set_queue(queue, t);
      std::uint64_t end = 0;
      for (std::uint64_t k = 0; k < available.size(); ++k)
        if (available[k] <= t) end = k + 1;
      if (i == 0) begun_at = end > 0 ? end - 1 : 0;
      std::uint64_t delivered = std::max(unread, begun_at);
      while (available[delivered] <= t) ++delivered;
      const std::uint64_t oldest =
          std::max({unread, begun_at, delivered > queue ? delivered - queue : std::uint64_t{0}});
      const Measurement got = schedule.choose(t, false);
      ASSERT_EQ(got.index, oldest) << "seed " << seed << ", read " << i;
      ASSERT_EQ(got.available_at <= t, oldest < delivered)
          << "what was delivered is not waited for";
      const auto at_once = schedule.choose_available(t, false);
      ASSERT_EQ(at_once.has_value(), got.available_at <= t);
      readable = schedule.first_readable(t);
      ASSERT_GE(got.index, readable);
      ASSERT_TRUE(end == 0 || schedule.choose(t, true).index == end - 1) << "the latest";
      schedule.mark_read(got);
      unread = got.index + 1;
      now = std::max(now, to_ns(got.available_at));
    }
  }
}

// A program may change its queue at each read; what had no place is not captured any more.
TEST(SensorSchedule, AQueueThatBecomesLongerHasNothingOfBefore) {
  SensorSchedule schedule = camera(milliseconds(10));
  KeyedRandom random({.seed = 7});
  SimTime t{};
  for (int i = 0; i < 500; ++i) {
    t += milliseconds(random.bits() % 200);
    const std::uint64_t kept = schedule.first_readable(t);
    schedule.set_queue(1 + random.bits() % 5, t);
    const Measurement got = schedule.choose(t, false);
    ASSERT_GE(got.index, kept) << i;
    if (got.available_at <= t) schedule.mark_read(got);
  }
}

// Against the definition: what is lost is not there for any kind of read, and takes no place in the
// queue; the rest is as without a driver.
TEST(SensorSchedule, LostSamplesAreNotThereForAnyRead) {
  const uav::PeriodicTiming timing{Duration(100), Duration(17),
                                   uav::NormalDelay{Duration(150), Duration(120)}};
  KeyedRandom random({.seed = 8});
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const uav::Driver driver({.stamp_offset = Duration(1000),
                              .stamp_jitter = Duration(40),
                              .lost_probability = 0.4,
                              .repeated_probability = 0.3},
                             timing.period, seed, "uav1", "camera");
    SensorSchedule schedule(timing, seed, 9, driver);
    std::vector<std::uint64_t> arrived;
    std::vector<SimTime> available;
    for (std::uint64_t k = 0; k < 900; ++k) {
      if (driver.loses(k)) continue;
      arrived.push_back(k);
      available.push_back(uav::sampling_instant(timing, k) + uav::draw(timing.delay, {seed, 9, k}));
    }
    const std::uint32_t queue = seed % 2 == 0 ? 1 : 2 + random.bits() % 6;
    std::size_t unread = 0;  // these are places in `arrived`
    std::optional<std::size_t> begun_at;
    SimTime last_stamp{};
    std::int64_t now = 0;
    for (int i = 0; i < 150; ++i) {
      now += random.bits() % 300;
      const auto t = from_ns<SimTime>(now);
      const std::uint64_t readable = schedule.first_readable(t);
      schedule.set_queue(queue, t);
      std::size_t end = 0;
      std::optional<std::size_t> newest, next;
      for (std::size_t n = 0; n < available.size(); ++n) {
        if (available[n] <= t) end = n + 1;
        if (available[n] <= t && n >= unread) newest = n;
        if (n >= unread && (!next || available[n] < available[*next])) next = n;
      }
      if (!begun_at) begun_at = end > 0 ? end - 1 : 0;
      std::size_t delivered = std::max(unread, *begun_at);
      while (available[delivered] <= t) ++delivered;
      const std::size_t expected =
          queue == 1 ? newest.value_or(*next)
                     : std::max({unread, *begun_at,
                                 delivered > queue ? delivered - queue : std::size_t{0}});
      const Measurement got = schedule.choose(t, false);
      ASSERT_EQ(got.index, arrived[expected]) << "seed " << seed << ", read " << i;
      ASSERT_EQ(got.available_at, available[expected]);
      ASSERT_EQ(schedule.choose_available(t, false).has_value(), got.available_at <= t);
      ASSERT_EQ(got.content(), driver.content_of(got.index));
      ASSERT_EQ(got.sampled_at, uav::sampling_instant(timing, got.content()));
      ASSERT_EQ(got.stamp, driver.stamp(uav::sampling_instant(timing, got.index), got.index));
      ASSERT_GE(got.content(), readable) << "its state is still there";
      ASSERT_GT(*got.stamp, last_stamp);
      last_stamp = *got.stamp;
      schedule.mark_read(got);
      unread = expected + 1;
      now = std::max(now, to_ns(got.available_at));
    }
  }
}

// On demand and in free running, two reads can be closer than the jitter.
TEST(SensorSchedule, StampsOfReadsDoNotGoBack) {
  const uav::DriverModel model{.stamp_offset = milliseconds(50), .stamp_jitter = milliseconds(5)};
  const uav::Driver driver(model, std::nullopt, 3, "uav1", "range");
  SensorSchedule on_demand(uav::OnDemandTiming{uav::ConstantDelay{Duration(0)}}, 3, 0, driver);
  SensorSchedule free = SensorSchedule::in_free_running(every_33_ms(Duration(0)), driver);
  for (auto* schedule : {&on_demand, &free}) {
    SimTime last{};
    for (std::int64_t i = 0; i < 300; ++i) {
      const Measurement got = schedule->choose(ms(2 * i), true);
      ASSERT_EQ(got.stamp, std::max(last, driver.stamp(got.sampled_at, got.index)));
      schedule->mark_read(got);
      last = *got.stamp;
    }
  }
}

TEST(SensorSchedule, InFreeRunningLostSamplesAreWaitedOver) {
  const uav::Driver driver({.lost_probability = 0.5}, std::nullopt, 3, "uav1", "camera");
  SensorSchedule schedule = SensorSchedule::in_free_running(every_33_ms(Duration(0)), driver);
  SimTime t = ms(0);
  for (std::uint64_t k = 0; k < 200; ++k) {
    if (driver.loses(k)) continue;
    const Measurement got = schedule.choose(t, false);
    ASSERT_EQ(got.index, k);
    ASSERT_EQ(got.sampled_at, ms(static_cast<std::int64_t>(33 * k)));
    schedule.mark_read(got);
    ASSERT_FALSE(schedule.choose_available(got.sampled_at, false));
    t = got.sampled_at;
  }
}

}  // namespace
}  // namespace tether::coordinator
