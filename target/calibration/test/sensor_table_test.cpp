#include <cmath>

#include <gmock/gmock.h>

#include <tether/calibration/characterize.h>

namespace tether::calibration {
namespace {

using std::chrono::milliseconds;

/// Experiments of acquisitions that took so many milliseconds.
SensorTimes times_of(const std::string& name, uav::SensorKind kind,
                     const std::vector<std::vector<int>>& experiments_ms) {
  SensorTimes times{name, kind, {}};
  ExecTime now;
  for (const std::vector<int>& experiment : experiments_ms) {
    times.experiments.emplace_back();
    for (const int taken_ms : experiment) {
      const ExecTime asked = now;
      now += milliseconds(taken_ms);
      times.experiments.back().push_back({asked, now, same_instant(asked), 0});
    }
  }
  return times;
}

TEST(Summarize, InterpolatesQuantiles) {
  std::vector<Duration> times;
  for (int i = 100; i >= 0; --i) times.push_back(milliseconds(10 * i));
  times.push_back(milliseconds(1010));
  const TimeSummary of = summarize(times);
  EXPECT_EQ(of.n, 102u);
  EXPECT_NEAR(of.mean_s, 0.505, 1e-12);
  EXPECT_NEAR(of.min_s, 0.0, 1e-12);
  EXPECT_NEAR(of.median_s, 0.505, 1e-12);
  EXPECT_NEAR(of.p95_s, 0.9595, 1e-12);
  EXPECT_NEAR(of.p99_s, 0.9999, 1e-12);
  EXPECT_NEAR(of.max_s, 1.01, 1e-12);
}

TEST(Summarize, SpreadIsThatOfASample) {
  EXPECT_NEAR(*summarize({milliseconds(1), milliseconds(3)}).stddev_s, std::sqrt(2.0) * 1e-3,
              1e-12);
  const TimeSummary single = summarize({milliseconds(7)});
  EXPECT_FALSE(single.stddev_s);
  EXPECT_EQ(single.p99_s, 0.007);
}

TEST(Experiments, HaveSpreadOfTheirMeans) {
  const auto kind = uav::SensorKind::kImu;
  EXPECT_FALSE(stddev_between_experiments_s(times_of("imu", kind, {{1, 5}})));
  const auto two = stddev_between_experiments_s(times_of("imu", kind, {{1, 3}, {2, 6}}));
  EXPECT_NEAR(*two, std::sqrt(2.0) * 1e-3, 1e-12);
}

TEST(Table1, IncludesThePapersRows) {
  const std::vector<SensorTimes> sensors = {
      times_of("camera", uav::SensorKind::kCamera, {{30, 40}, {35}}),
      times_of("imu", uav::SensorKind::kImu, {{1}}),
      times_of("range", uav::SensorKind::kRange, {{98}})};
  EXPECT_EQ(table_1({"virtual", "pi, cpu × 6"}, sensors),
            "Table I: mean time to acquire a sensor's data [s]\n"
            "data origin    SUT location  camera     imu   range\n"
            "virtual        pi, cpu × 6   0.0350  0.0010  0.0980\n"
            "paper:\n"
            "  real sensor  target        0.0374       -  0.0977\n"
            "  virtual      target        0.2510       -  0.0492\n"
            "  virtual      host          0.0561       -  0.0441\n"
            "(paper, Table I: means of ten experiments, spread not published)\n");
}

TEST(DistributionTable, ShowsDistributionOfEachRow) {
  EXPECT_EQ(distribution_table({{"camera", {milliseconds(30), milliseconds(40)}, std::nullopt},
                                {"imu", {Duration(1'500'000)}, std::nullopt}}),
            "[ms]    n    mean     sd     min  median     p95     p99     max\n"
            "camera  2  35.000  7.071  30.000  35.000  39.500  39.900  40.000\n"
            "imu     1   1.500      -   1.500   1.500   1.500   1.500   1.500\n");
  EXPECT_THAT(distribution_table({{"camera", {milliseconds(30)}, 0.002}}),
              ::testing::HasSubstr("sd of experiments' means\n"));
}

}  // namespace
}  // namespace tether::calibration
