#include <gmock/gmock.h>

#include <tether/calibration/characterize.h>
#include <tether/tasks/testing/planar_vehicle.h>

namespace tether::calibration {
namespace {

using std::chrono::milliseconds;
using tasks::testing::PlanarVehicle;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

CharacterizeOptions few(std::vector<std::string> sensors = {}) {
  CharacterizeOptions options;
  options.sensors = std::move(sensors);
  options.acquisitions = 4;
  return options;
}

TEST(Characterize, TakesEverySensorInTurn) {
  PlanarVehicle vehicle({});
  std::vector<std::string> told;
  const Characterization result =
      characterize(vehicle, few(), [&told](const std::string& what) { told.push_back(what); });
  ASSERT_TRUE(result.outcome.reached()) << result.outcome.reason;
  ASSERT_EQ(result.sensors.size(), 3u);
  EXPECT_EQ(result.sensors[0].sensor, "camera");
  EXPECT_EQ(result.sensors[1].kind, uav::SensorKind::kImu);
  EXPECT_EQ(result.sensors[2].taken(), std::vector<Duration>(4, milliseconds(30)));
  EXPECT_THAT(told, ElementsAre("camera: experiment 1 of 1", "imu: experiment 1 of 1",
                                "range: experiment 1 of 1"));
  EXPECT_NEAR(result.outcome.results.at("range_mean_s"), 0.03, 1e-12);
  EXPECT_EQ(result.outcome.results.at("range_n"), 4);
  EXPECT_NEAR(result.outcome.results.at("range_p99_s"), 0.03, 1e-12);
  EXPECT_FALSE(result.outcome.results.contains("range_stddev_between_experiments_s"));
  EXPECT_FALSE(vehicle.finished());
}

// The first measurement, of a sensor that is being turned on, is not among them.
TEST(Characterize, RepeatsExperiments) {
  PlanarVehicle vehicle({.range_delays = {milliseconds(99), milliseconds(10), milliseconds(30)}});
  CharacterizeOptions options = few({"range"});
  options.acquisitions = 1;
  options.experiments = 2;
  const Characterization result = characterize(vehicle, options);
  ASSERT_EQ(result.sensors.size(), 1u);
  EXPECT_EQ(result.sensors[0].experiments.size(), 2u);
  EXPECT_THAT(result.sensors[0].taken(), ElementsAre(milliseconds(10), milliseconds(30)));
  EXPECT_NEAR(result.outcome.results.at("range_stddev_between_experiments_s"), 0.01414, 1e-5);
}

TEST(Characterize, RefusesBeforeItMeasures) {
  PlanarVehicle vehicle({});
  CharacterizeOptions periodic = few({"camera", "range"}), many;
  periodic.timing = Timing::kPeriodic;
  many.acquisitions = kMostAcquisitions / 2;
  for (const auto& [options, name] :
       {std::pair(few({"camera", "gps"}), "\"gps\""), std::pair(few({"imu", "imu"}), "\"imu\""),
        std::pair(periodic, "\"range\""), std::pair(many, "90000")}) {
    const Characterization refused = characterize(vehicle, options);
    EXPECT_EQ(refused.outcome.failure, Failure::Kind::kInvalid);
    EXPECT_THAT(refused.outcome.reason, HasSubstr(name));
    EXPECT_EQ(vehicle.now(), ExecTime());
  }
}

// 1 MiB of TOML, with 14 bytes for the longest delay: "59999.999999, ".
TEST(Characterize, AllAcquisitionsFitAProfile) {
  EXPECT_LT(kMostAcquisitions * 14, 1 << 20);
  CharacterizeOptions options;
  options.acquisitions = kMostAcquisitions / 2;
  EXPECT_TRUE(check_extent(options, 2));
  options.acquisitions = options.experiments = kMostAcquisitions;
  EXPECT_FALSE(check_extent(options, 1));
}

TEST(Characterize, FailsIfOneSensorFails) {
  PlanarVehicle vehicle({.disconnect_at = 6});
  const Characterization result = characterize(vehicle, few());
  EXPECT_EQ(result.outcome.failure, Failure::Kind::kDisconnected);
  EXPECT_FALSE(result.outcome.results.contains("camera_mean_s"));
}

TEST(Characterize, TimeLimitAppliesToEachSensor) {
  PlanarVehicle vehicle({.range_delays = {milliseconds(300)}});
  CharacterizeOptions options = few({"camera", "range"});
  options.experiments = 3;
  options.time_limit = milliseconds(2000);
  const Characterization result = characterize(vehicle, options);
  EXPECT_EQ(result.outcome.status, tasks::TaskStatus::kNotReached);
  EXPECT_EQ(result.outcome.reason,
            "time limit after 2 acquisitions of sensor \"range\" in experiment 2");
}

}  // namespace
}  // namespace tether::calibration
