#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include <tether/calibration/characterize.h>

namespace tether::calibration {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using ::testing::HasSubstr;

/// Samples of a camera at 40 Hz that arrive so long after their instants.
struct Camera {
  Duration period = milliseconds(25);
  Duration delay = milliseconds(8);
  int samples = 6;
  int index_step = 1;
};

SensorTimes watch(const Camera& camera, int experiments = 1) {
  SensorTimes times{"camera", uav::SensorKind::kCamera, {}};
  std::uint64_t index = 0;
  ExecTime now;
  for (int e = 0; e < experiments; ++e) {
    times.experiments.emplace_back();
    for (int i = 0; i < camera.samples; ++i) {
      const ExecTime sampled(static_cast<std::int64_t>(index) * camera.period);
      const ExecTime had = sampled + camera.delay + microseconds(i % 2);
      times.experiments.back().push_back({now, had, same_instant(sampled), index});
      now = had;
      index += static_cast<std::uint64_t>(camera.index_step);
    }
  }
  return times;
}

TEST(OnDemandTiming, IsFromRequestToResult) {
  const TimingModel model = on_demand_timing(watch({.samples = 3}));
  EXPECT_FALSE(model.period);
  EXPECT_THAT(model.delays,
              ::testing::ElementsAre(milliseconds(8), milliseconds(25) + microseconds(1),
                                     milliseconds(25) - microseconds(1)));
}

TEST(PeriodicTiming, HasPeriodAndDelays) {
  for (const int index_step : {1, 3}) {
    const auto model = periodic_timing(watch({.index_step = index_step}, 2), true);
    ASSERT_TRUE(model) << model.failure().message;
    EXPECT_EQ(model->period, milliseconds(25)) << "missed samples are no longer period";
    ASSERT_EQ(model->delays.size(), 10u) << "without the first of each experiment";
    EXPECT_EQ(model->delays[0], milliseconds(8) + microseconds(1));
    EXPECT_EQ(model->delays[1], milliseconds(8));
  }
}

TEST(PeriodicTiming, ThePeriodIsFinerThanTheGridOfItsInstants) {
  SensorTimes times = watch({.period = Duration(33'333'333), .samples = 31});
  for (auto& acquisition : times.experiments[0]) {
    acquisition.sampled_at = std::chrono::floor<milliseconds>(acquisition.sampled_at);
  }
  const auto model = periodic_timing(times, true);
  ASSERT_TRUE(model) << model.failure().message;
  EXPECT_NEAR(to_seconds(*model->period), 0.0333333, 0.04e-3);
}

TEST(PeriodicTiming, IgnoresGaps) {
  SensorTimes times = watch({.samples = 10});
  for (std::size_t i = 5; i < 10; ++i) {
    times.experiments[0][i].sampled_at += milliseconds(200);
    times.experiments[0][i].had_at += milliseconds(200);
  }
  EXPECT_EQ(periodic_timing(times, true)->period, milliseconds(25));
}

/// The simulation runs at its own pace, as in a run without synchronisation.
SensorTimes watch_unsynchronised(double real_time_factor, const Camera& camera) {
  SensorTimes times = watch(camera);
  for (auto& acquisition : times.experiments[0]) {
    const double instant_s = to_seconds(acquisition.sampled_at) / real_time_factor;
    const Duration late = acquisition.had_at - same_instant(acquisition.sampled_at);
    acquisition.had_at = ExecTime(duration_from_seconds(instant_s)) + late;
    acquisition.sampled_at = std::chrono::floor<milliseconds>(acquisition.sampled_at);
  }
  return times;
}

TEST(PeriodicTiming, RefusesTimestampsOfAnotherSpeed) {
  const std::vector<std::pair<double, int>> factors_and_samples = {
      {0.3, 5}, {0.3, 100}, {0.8, 20}, {0.8, 100}, {0.95, 100}, {1.05, 100}, {3.0, 20}};
  for (const auto& [factor, samples] : factors_and_samples) {
    const auto model = periodic_timing(watch_unsynchronised(factor, {.samples = samples}), false);
    ASSERT_FALSE(model) << factor << " with " << samples;
    EXPECT_EQ(model.failure().kind, Failure::Kind::kInvalid);
  }
  EXPECT_TRUE(periodic_timing(watch_unsynchronised(1.0, {.samples = 100}), false));
}

// A delay that jitters by more than a period is no other pace, however short the span.
TEST(PeriodicTiming, AcceptsJitter) {
  for (const int samples : {4, 10, 100}) {
    for (unsigned seed = 0; seed < 20; ++seed) {
      SensorTimes times = watch({.delay = milliseconds(60), .samples = samples});
      unsigned state = seed;
      for (auto& acquisition : times.experiments[0]) {
        state = state * 1'664'525u + 1'013'904'223u;
        acquisition.had_at += milliseconds(state >> 27);  // 0 to 31
      }
      EXPECT_TRUE(periodic_timing(times, true)) << samples << " samples, seed " << seed;
    }
  }
}

TEST(ChooseTiming, IsPeriodicIfTheSensorHasARateAndFits) {
  SensorTimes times = watch({});
  EXPECT_FALSE(choose_timing(times, Timing::kAuto, true)->model.period) << "it tells no rate";
  EXPECT_TRUE(choose_timing(times, Timing::kPeriodic, true)->model.period);
  times.rate_hz = 40.0;
  const auto chosen = choose_timing(times, Timing::kAuto, true);
  EXPECT_EQ(chosen->model.period, milliseconds(25));
  EXPECT_EQ(chosen->note, "");
  EXPECT_FALSE(choose_timing(times, Timing::kOnDemand, true)->model.period);
}

TEST(ChooseTiming, FallsBackToOnDemandWithANote) {
  SensorTimes stamped = watch({.delay = milliseconds(3)});
  stamped.rate_hz = 40.0;
  const auto chosen = choose_timing(stamped, Timing::kAuto, true);
  ASSERT_TRUE(chosen);
  EXPECT_EQ(chosen->model.delays, stamped.taken());
  EXPECT_THAT(chosen->note, HasSubstr("\"camera\""));
  const auto refused = choose_timing(stamped, Timing::kPeriodic, true);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.failure().message, HasSubstr("--timing on_demand"));
}

TEST(PeriodicTiming, RefusesSamplesWithoutAPeriodOrInstantsOfTheirOwn) {
  EXPECT_TRUE(periodic_timing(watch({.delay = milliseconds(6)}), true));
  // A virtual camera can have no delay at all, and its instants are its own.
  EXPECT_TRUE(periodic_timing(watch({.delay = Duration(0)}), false));
  SensorTimes erratic = watch({.samples = 7}), still = erratic;
  for (std::size_t i : {2u, 3u, 5u}) erratic.experiments[0][i].sampled_at -= milliseconds(7);
  for (auto& acquisition : still.experiments[0]) acquisition.sampled_at = SimTime();
  for (const auto& model : {periodic_timing(watch({.delay = milliseconds(3)}), true),
                            periodic_timing(watch({.delay = milliseconds(-5)}), false),
                            periodic_timing(watch({.period = microseconds(9)}), false),
                            periodic_timing(watch({.period = std::chrono::seconds(1001)}), false),
                            periodic_timing(watch({.samples = 3}), true),
                            periodic_timing(erratic, true), periodic_timing(still, true)}) {
    ASSERT_FALSE(model);
    EXPECT_EQ(model.failure().kind, Failure::Kind::kInvalid);
    EXPECT_THAT(model.failure().message, HasSubstr("\"camera\""));
  }
}

}  // namespace
}  // namespace tether::calibration
