#include <cmath>

#include <gmock/gmock.h>

#include <tether/tasks/paper_tasks.h>
#include <tether/tasks/task.h>
#include <tether/tasks/testing/planar_vehicle.h>

namespace tether::tasks {
namespace {

using std::chrono::milliseconds;
using testing::PlanarVehicle;

TaskOutcome characterize(PlanarVehicle& vehicle, const std::string& sensor,
                         const SensorCharacterizationOptions& options = {}) {
  TaskContext context(vehicle);
  SensorCharacterizationTask task(sensor, options);
  return run(task, context);
}

TEST(SensorCharacterizationTask, TimesEachAcquisition) {
  PlanarVehicle vehicle(
      {.range_delays = {milliseconds(10), milliseconds(40), milliseconds(20), milliseconds(30)}});
  SensorCharacterizationOptions options;
  options.acquisitions = 8;
  const TaskOutcome outcome = characterize(vehicle, "range", options);
  EXPECT_TRUE(outcome.reached());
  EXPECT_NEAR(outcome.results.at("duration_s"), 0.2, 1e-12);
  EXPECT_EQ(outcome.results.at("acquisitions"), 8);
  EXPECT_NEAR(outcome.results.at("mean_s"), 0.025, 1e-12);
  EXPECT_NEAR(outcome.results.at("median_s"), 0.025, 1e-12);
  EXPECT_NEAR(outcome.results.at("min_s"), 0.01, 1e-12);
  EXPECT_NEAR(outcome.results.at("max_s"), 0.04, 1e-12);
  // Squares off the mean: 2 · (15² + 15² + 5² + 5²) = 1000 ms², over 7.
  EXPECT_NEAR(outcome.results.at("stddev_s"), std::sqrt(1000.0 / 7.0) * 1e-3, 1e-12);
  EXPECT_TRUE(vehicle.commands().empty());
}

TEST(SensorCharacterizationTask, TakesAnySensorWaitingForWhatIsNew) {
  PlanarVehicle vehicle({});
  const TaskOutcome camera = characterize(vehicle, "camera");
  EXPECT_TRUE(camera.reached());
  EXPECT_EQ(vehicle.images_read(), 100);
  EXPECT_NEAR(camera.results.at("mean_s"), 1.0 / 30.0, 1e-3);
  const TaskOutcome imu = characterize(vehicle, "imu");
  EXPECT_TRUE(imu.reached());
  EXPECT_NEAR(imu.results.at("median_s"), 0.005, 1e-9);
}

TEST(SensorCharacterizationTask, TellsOfEachAcquisition) {
  PlanarVehicle vehicle({.range_delays = {milliseconds(10), milliseconds(40)}});
  TaskContext context(vehicle);
  SensorCharacterizationOptions options;
  options.acquisitions = 3;
  SensorCharacterizationTask task("range", options);
  ASSERT_TRUE(run(task, context).reached());
  ASSERT_EQ(task.acquisitions().size(), 3u);
  const std::vector<int> asked_ms = {0, 10, 50};
  const std::vector<int> had_ms = {10, 50, 60};
  for (std::size_t i = 0; i < 3; ++i) {
    const Acquisition& acquisition = task.acquisitions()[i];
    EXPECT_EQ(acquisition.asked_at, ExecTime(milliseconds(asked_ms[i])));
    EXPECT_EQ(acquisition.had_at, ExecTime(milliseconds(had_ms[i])));
    EXPECT_EQ(acquisition.sampled_at, SimTime(milliseconds(asked_ms[i])));
    EXPECT_EQ(acquisition.index, i);
  }
}

TEST(SensorCharacterizationTask, EndsAtItsTimeLimit) {
  PlanarVehicle vehicle({.range_delays = {milliseconds(300)}});
  SensorCharacterizationOptions options;
  options.time_limit = milliseconds(700);
  const TaskOutcome outcome = characterize(vehicle, "range", options);
  EXPECT_EQ(outcome.status, TaskStatus::kNotReached);
  EXPECT_EQ(outcome.reason, "time limit");
  EXPECT_EQ(outcome.results.at("acquisitions"), 3);
}

TEST(SensorCharacterizationTask, ResultsOfOneAcquisitionOnAStoppedClock) {
  PlanarVehicle vehicle({.clock_stands_still = true});
  SensorCharacterizationOptions options;
  options.acquisitions = 1;
  const TaskOutcome outcome = characterize(vehicle, "range", options);
  EXPECT_TRUE(outcome.reached());
  EXPECT_EQ(outcome.results.at("duration_s"), 0.0);
  EXPECT_EQ(outcome.results.at("mean_s"), outcome.results.at("max_s"));
  EXPECT_FALSE(outcome.results.contains("stddev_s"));
}

TEST(SensorCharacterizationTask, KeepsTheAcquisitionsOfARunThatFails) {
  PlanarVehicle vehicle({});
  const TaskOutcome unknown = characterize(vehicle, "gps");
  EXPECT_EQ(unknown.failure, Failure::Kind::kInvalid);
  EXPECT_THAT(unknown.reason, ::testing::HasSubstr("\"gps\""));
  PlanarVehicle cut({.disconnect_at = 2});
  TaskContext context(cut);
  SensorCharacterizationTask task("imu");
  const TaskOutcome outcome = run(task, context);
  EXPECT_EQ(outcome.failure, Failure::Kind::kDisconnected);
  EXPECT_EQ(outcome.results.at("acquisitions"), 2);
  EXPECT_EQ(task.acquisitions().size(), 2u);
  EXPECT_FALSE(run(task, context).reached());
  EXPECT_TRUE(task.acquisitions().empty()) << "of the last run only";
}

}  // namespace
}  // namespace tether::tasks
