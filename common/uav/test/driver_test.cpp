#include <cmath>

#include <gmock/gmock.h>

#include <tether/uav/sensor_timing.h>

namespace tether::uav {
namespace {

using std::chrono::milliseconds;

constexpr Duration kPeriod = milliseconds(5);

Driver driver(const DriverModel& model, std::optional<Duration> period = kPeriod) {
  return {model, period, 7, "uav1", "imu"};
}
SimTime instant(std::uint64_t index) {
  return SimTime(static_cast<std::int64_t>(index) * kPeriod);
}

TEST(Driver, WithoutAModelStampsAreTheInstants) {
  EXPECT_FALSE(Driver().is_modelled());
  EXPECT_FALSE(Driver().loses(3));
  EXPECT_EQ(Driver().content_of(3), 3u);
  EXPECT_EQ(driver({}).stamp(instant(9), 9), instant(9));
}

TEST(Driver, OffsetAndDriftMoveStampsExactlyAndNoneIsBeforeTheStart) {
  const Driver late = driver({.stamp_offset = milliseconds(-12), .stamp_drift_ppb = 20'500});
  EXPECT_TRUE(late.is_modelled());
  EXPECT_EQ(late.stamp(SimTime(), 0), SimTime());
  EXPECT_EQ(late.stamp(SimTime(std::chrono::seconds(1000)), 1),
            SimTime(std::chrono::seconds(1000) - milliseconds(12) + Duration(20'500'000)));
  const Driver slow = driver({.stamp_drift_ppb = -100'000'000});
  EXPECT_EQ(slow.stamp(from_ns<SimTime>(10'000'000'015), 1), from_ns<SimTime>(9'000'000'014));
}

// With the most jitter that a profile allows, and the most drift.
TEST(Driver, JitterHasItsSpreadAndStampsOfAPeriodicSensorRise) {
  const Driver exact = driver({.stamp_offset = std::chrono::seconds(1),
                               .stamp_jitter = kPeriod / 2,
                               .stamp_drift_ppb = -100'000'000});
  for (std::uint64_t k = 1; k < 20'000; ++k)
    ASSERT_GT(exact.stamp(instant(k), k), exact.stamp(instant(k - 1), k - 1)) << k;

  const Driver wide =
      driver({.stamp_offset = std::chrono::seconds(1), .stamp_jitter = Duration(100'000)});
  constexpr int kDraws = 20'000;
  double sum_ns = 0.0, squares_ns2 = 0.0;
  for (std::uint64_t k = 0; k < kDraws; ++k) {
    const auto error = wide.stamp(instant(k), k) - instant(k) - std::chrono::seconds(1);
    sum_ns += static_cast<double>(error.count());
    squares_ns2 += static_cast<double>(error.count()) * static_cast<double>(error.count());
  }
  EXPECT_NEAR(sum_ns / kDraws, 0.0, 3'000.0);
  EXPECT_NEAR(std::sqrt(squares_ns2 / kDraws), 100'000.0, 2'000.0);
}

TEST(Driver, ARepeatedSampleHasTheContentOfTheOneThatArrivedBefore) {
  const Driver bad = driver({.lost_probability = 0.3, .repeated_probability = 0.2});
  int lost = 0, repeated = 0;
  std::optional<std::uint64_t> before;  // the content of the newest that arrived
  for (std::uint64_t k = 0; k < 10'000; ++k) {
    if (bad.loses(k)) {
      ++lost;
      continue;
    }
    const std::uint64_t content = bad.content_of(k);
    if (content != k) {
      ++repeated;
      ASSERT_EQ(content, before) << k;
    }
    before = content;
  }
  EXPECT_NEAR(lost, 3000, 200);
  EXPECT_NEAR(repeated, 1400, 150);
}

TEST(Driver, DrawsOfTwoSensorsDiffer) {
  const DriverModel model{.lost_probability = 0.5};
  const Driver other{model, kPeriod, 7, "uav1", "camera"};
  int same = 0;
  for (std::uint64_t k = 0; k < 1000; ++k) same += driver(model).loses(k) == other.loses(k) ? 1 : 0;
  EXPECT_NEAR(same, 500, 70);
}

}  // namespace
}  // namespace tether::uav
