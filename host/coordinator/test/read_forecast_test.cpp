#include "read_forecast.h"

#include <gtest/gtest.h>

namespace tether::coordinator {
namespace {

using std::chrono::milliseconds;

/// A sensor at 30 Hz, 37 ms late, whose SUT pauses for so long after each reply.
struct Case {
  const char* what;
  std::vector<int> pauses_ms;
  std::optional<std::uint64_t> next;
};

TEST(ReadForecast, IsWhatTheNextReadGetsAfterEachOfTheLastPauses) {
  const SensorSchedule schedule{
      uav::PeriodicTiming{milliseconds(30), Duration(0), uav::ConstantDelay{milliseconds(37)}}, 0,
      0};
  const Case cases[] = {
      {"no read before", {}, std::nullopt},
      {"one pause", {20}, std::nullopt},
      {"shorter than the period", {20, 20}, 3u},
      {"of different lengths, with the same result", {2, 20}, 3u},
      {"of different lengths, with different results", {20, 65}, std::nullopt},
      {"longer than two periods", {61, 65, 63}, 8u},
      {"an old exception", {20, 100, 20, 20, 20, 20}, 9u},
      {"a recent exception", {20, 20, 20, 100, 20, 20}, std::nullopt},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.what);
    SensorSchedule sensor = schedule;
    ReadForecast forecast;
    SimTime t{};
    const auto read = [&] {
      const Measurement measurement = sensor.choose(t, false);
      sensor.mark_read(measurement);
      forecast.requested(t, false);
      t = std::max(t, measurement.available_at);
      EXPECT_EQ(forecast.next(sensor), std::nullopt) << "while a read is open";
      forecast.replied(t);
    };
    if (!c.pauses_ms.empty()) read();
    for (const int pause_ms : c.pauses_ms) {
      t += milliseconds(pause_ms);
      read();
    }
    EXPECT_EQ(forecast.next(sensor), c.next);
  }
}

// A read of the newest measurement may get the one that it had.
TEST(ReadForecast, FollowsHowTheLastReadChose) {
  SensorSchedule schedule{
      uav::PeriodicTiming{milliseconds(30), Duration(0), uav::ConstantDelay{Duration(0)}}, 0, 0};
  ReadForecast forecast;
  for (int i = 0; i < 3; ++i) {
    const SimTime t{milliseconds(i)};
    schedule.mark_read(schedule.choose(t, true));
    forecast.requested(t, true);
    forecast.replied(t);
  }
  EXPECT_EQ(forecast.next(schedule), 0u);
}

}  // namespace
}  // namespace tether::coordinator
