#include "sensors/read_forecast.h"

#include <gtest/gtest.h>

#include <tether/base/random.h>

namespace tether::coordinator {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

/// A sensor with a period of 30 ms, 37 ms late, and a serial SUT that reads it.
class Reader {
 public:
  void read(Duration pause, bool latest = false) {
    t_ += pause;
    const Measurement measurement = sensor_.choose(t_, latest);
    sensor_.mark_read(measurement);
    forecast_.requested(t_, latest, measurement.index);
    t_ = std::max(t_, measurement.available_at);
    EXPECT_EQ(forecast_.next(sensor_), std::nullopt) << "while a read is open";
    forecast_.replied(t_);
    last_ = measurement.index;
  }
  std::optional<std::uint64_t> next() { return forecast_.next(sensor_); }
  std::uint64_t last() const { return last_; }

 private:
  SensorSchedule sensor_{
      uav::PeriodicTiming{milliseconds(30), Duration(0), uav::ConstantDelay{milliseconds(37)}}, 0,
      0};
  ReadForecast forecast_;
  SimTime t_{};
  std::uint64_t last_ = 0;
};

struct Case {
  const char* what;
  std::vector<int> pauses_ms;  ///< before each read
  std::optional<std::uint64_t> next;
};

TEST(ReadForecast, IsWhatTheNextReadGetsAfterEachOfTheLastPauses) {
  const Case cases[] = {
      {"too few reads", {0, 20, 20, 20, 20, 20, 20, 20}, std::nullopt},
      {"shorter than the period", {0, 20, 20, 20, 20, 20, 20, 20, 20}, 9u},
      {"of different lengths, with the same result", {0, 20, 20, 20, 20, 20, 20, 2, 20}, 9u},
      {"with different results", {0, 20, 20, 20, 20, 20, 20, 20, 65}, std::nullopt},
      {"longer than two periods", {0, 61, 65, 63, 61, 65, 63, 61, 65}, 18u},
      {"an old exception", {0, 20, 20, 20, 100, 20, 20, 20, 20}, 11u},
      {"a recent exception", {0, 20, 20, 20, 20, 20, 100, 20, 20}, std::nullopt},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.what);
    Reader reader;
    for (const int pause_ms : c.pauses_ms) reader.read(milliseconds(pause_ms));
    EXPECT_EQ(reader.next(), c.next);
    EXPECT_EQ(reader.next(), std::nullopt) << "the same again";
  }
}

// A read of the newest measurement may get the one that it had.
TEST(ReadForecast, FollowsHowTheLastReadChose) {
  Reader reader;
  reader.read(milliseconds(100));
  for (int i = 0; i < 8; ++i) reader.read(milliseconds(1), true);
  EXPECT_EQ(reader.next(), reader.last());
}

// Bursts of steady reads, then something else for a while: the next read after a burst is never
// the one that was forecast.
TEST(ReadForecast, IsInVainForAtMostOneInTen) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    KeyedRandom random({.seed = seed});
    const std::uint64_t burst = 1 + random.bits() % 40, jitter_us = 1 + random.bits() % 60'000;
    Reader reader;
    std::size_t forecasts = 0, vain = 0;
    for (std::size_t reads = 1; reads <= 300; ++reads) {
      const bool is_first = random.bits() % burst == 0;
      const auto expected = reader.next();
      if (expected) ++forecasts;
      // If nothing more is read, this one is in vain, too.
      EXPECT_LE(10 * (vain + (expected ? 1 : 0)), reads - 1 + vain + (expected ? 1 : 0));
      reader.read(is_first ? Duration(std::chrono::seconds(1))
                           : Duration(microseconds(random.bits() % jitter_us)));
      if (expected && *expected != reader.last()) ++vain;
    }
    if (burst > 30 && jitter_us < 20'000) {
      EXPECT_GT(forecasts, 100u);
    }
  }
}

}  // namespace
}  // namespace tether::coordinator
