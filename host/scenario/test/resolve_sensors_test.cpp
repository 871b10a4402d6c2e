#include "full_scenario.h"
#include "sensor_world.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/scenario/scenario.h>

namespace tether::scenario {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

sim::World world_of_two() {
  sim::World world;
  world.uavs.resize(2);
  world.uavs[0].name = "uav1";
  world.uavs[0].sensors = {make_range("range", 7.0), make_imu("imu", 100.0),
                           make_camera("camera", 60.0)};
  world.uavs[1].name = "uav2";
  world.uavs[1].sensors = {make_imu("imu"), make_range("range", 0.0)};
  return world;
}

class ResolveSensors : public testing::Test {
 protected:
  using Timings = std::vector<std::vector<uav::SensorTiming>>;
  Timings resolve(const std::string& condition = "host") {
    return resolve_sensors(scenario_, *scenario_.find_condition(condition), world_,
                           [&](const std::string& text) { warnings_.push_back(text); });
  }
  std::string error() {
    return bad_file_message([&] { (void)resolve(); });
  }
  /// Lays on top a profile with these lines from line 2 on.
  void lay(const std::string& file, const std::string& lines) {
    const auto path = scratch_.write(file, "name = \"" + file + "\"\n" + lines);
    lay_profile(scenario_, load_profile(path));
  }
  const sim::Sensor& sensor(std::size_t uav, std::size_t index) const {
    return world_.uavs[uav].sensors[index];
  }
  double max_m(std::size_t uav, std::size_t index) const {
    return std::get<sim::RangeModel>(sensor(uav, index).model).max_m;
  }
  ScratchFolder scratch_;
  Scenario scenario_ = load_scenario(write_project(scratch_, kFullScenario));
  sim::World world_ = world_of_two();
  std::vector<std::string> warnings_;
};

// Timings, as in the order of the world.

TEST_F(ResolveSensors, TimingsFollowTheOrderOfTheWorldsSensors) {
  const auto timings = resolve();
  ASSERT_EQ(timings.size(), 2u);
  ASSERT_EQ(timings[0].size(), 3u);
  EXPECT_TRUE(std::holds_alternative<uav::OnDemandTiming>(timings[0][0]));
  EXPECT_EQ(std::get<uav::PeriodicTiming>(timings[0][1]).period, milliseconds(50));
  EXPECT_EQ(std::get<uav::PeriodicTiming>(timings[0][2]).phase, milliseconds(3));
}

TEST_F(ResolveSensors, ASensorThatNothingTimesFollowsSdf) {
  const auto timings = resolve();
  const auto& imu = std::get<uav::PeriodicTiming>(timings[1][0]);
  EXPECT_EQ(imu.period, milliseconds(50));
  EXPECT_EQ(imu.phase, Duration{0});
  EXPECT_EQ(std::get<uav::ConstantDelay>(imu.delay).value, Duration{0});
  const auto& range = std::get<uav::OnDemandTiming>(timings[1][1]);
  EXPECT_EQ(std::get<uav::ConstantDelay>(range.delay).value, Duration{0});
}

// Layers.

TEST_F(ResolveSensors, LayersGoOverEachOtherInOrder) {
  const std::string range = "[sensors.range]\nkind = \"range\"\nmax_m = ";
  scenario_.uavs[0].profile =
      load_profile(scratch_.write("below.toml", "name = \"b\"\n" + range + "1\n"));
  resolve();
  EXPECT_EQ(max_m(0, 0), 1.0);
  EXPECT_EQ(max_m(1, 1), 4.0);

  scenario_.uavs[0].sensors.at("range").max_m = 2.0;
  resolve();
  EXPECT_EQ(max_m(0, 0), 2.0);

  resolve("scripted");  // has "fog", for all UAVs
  EXPECT_EQ(max_m(0, 0), 3.0);
  EXPECT_EQ(max_m(1, 1), 3.0);

  lay("top.toml", range + "5\n");
  resolve("scripted");
  EXPECT_EQ(max_m(0, 0), 5.0);
  EXPECT_EQ(max_m(1, 1), 5.0);
  EXPECT_THAT(warnings_, IsEmpty());
}

TEST_F(ResolveSensors, TheScenariosOwnTableGoesOverTheUavsProfile) {
  const auto timings = resolve();
  EXPECT_TRUE(std::holds_alternative<uav::PeriodicTiming>(timings[0][2]));
  EXPECT_EQ(std::get<sim::CameraModel>(sensor(0, 2).model).pixel_noise.stddev, 0.02);
}

TEST_F(ResolveSensors, AConditionsDelayKeepsTheTimingBelow) {
  const auto timings = resolve("scripted");
  const auto& range = std::get<uav::OnDemandTiming>(timings[0][0]);
  EXPECT_THAT(std::get<uav::EmpiricalDelay>(range.delay).samples,
              ElementsAre(milliseconds(90), milliseconds(110)));
}

// Which sensor an entry of a profile is of.

TEST_F(ResolveSensors, AnEntryIsOfTheOnlySensorOfItsKind) {
  lay("p.toml", "[sensors.tof]\nkind = \"range\"\nmax_m = 2\n");
  resolve();
  EXPECT_EQ(max_m(0, 0), 2.0);
  EXPECT_EQ(max_m(1, 1), 2.0);
}

TEST_F(ResolveSensors, AnEntryIsOfTheSensorOfItsNameAmongSeveral) {
  world_.uavs[0].sensors.push_back(make_range("down"));
  lay("p.toml", "[sensors.down]\nkind = \"range\"\nmax_m = 2\n");
  resolve();
  EXPECT_EQ(max_m(0, 0), 4.0);
  EXPECT_EQ(max_m(0, 3), 2.0);
}

TEST_F(ResolveSensors, ANameOfAnotherKindIsNoMatch) {
  lay("p.toml", "[sensors.camera]\nkind = \"range\"\nmax_m = 2\n");
  resolve();
  EXPECT_EQ(max_m(0, 0), 2.0);
}

TEST_F(ResolveSensors, WarnsOfAKindThatTheUavLacks) {
  lay("p.toml", "[sensors.front]\nkind = \"camera\"\nnoise = {}\n");
  resolve();
  EXPECT_THAT(warnings_, ElementsAre(scratch_.path("p.toml").string() +
                                     ":2: the UAV 'uav2' has no sensor of the kind \"camera\" for "
                                     "[sensors.front] of the profile 'p.toml'"));
}

TEST_F(ResolveSensors, ASensorThatIsNamedIsNotTakenForAnother) {
  lay("p.toml",
      "[sensors.down]\nkind = \"range\"\nmax_m = 1\n[sensors.range]\nkind = \"range\"\nmax_m = "
      "2\n");
  resolve();
  EXPECT_EQ(max_m(0, 0), 2.0);
  EXPECT_EQ(max_m(1, 1), 2.0);
  EXPECT_THAT(warnings_, ElementsAre(scratch_.path("p.toml").string() +
                                         ":2: the UAV 'uav1' has one sensor of the kind \"range\" "
                                         "only, and that is [sensors.range] (line 5); it has none "
                                         "for [sensors.down] of the profile 'p.toml'",
                                     HasSubstr("'uav2' has one sensor of the kind")));
}

TEST_F(ResolveSensors, RefusesTwoEntriesOfOneSensor) {
  lay("p.toml", "[sensors.a]\nkind = \"imu\"\n[sensors.b]\nkind = \"imu\"\n");
  EXPECT_THAT(error(), HasSubstr("p.toml:4: [sensors.b] and [sensors.a] (line 2) would both be of "
                                 "'imu', the only sensor of the kind \"imu\" of the UAV 'uav1'; "
                                 "call the one that is meant [sensors.imu]"));
}

TEST_F(ResolveSensors, RefusesAnEntryThatCouldBeOfSeveral) {
  world_.uavs[0].sensors.push_back(make_range("down"));
  lay("p.toml", "[sensors.front]\nkind = \"range\"\n");
  EXPECT_THAT(error(), HasSubstr("p.toml:2: the UAV 'uav1' has no sensor 'front' of the kind "
                                 "\"range\", but 'range' and 'down'; name the one that is meant"));
}

// What is wrong in the scenario.

TEST_F(ResolveSensors, ASensorThatTheUavLacksIsAnErrorAtItsLine) {
  world_.uavs[0].sensors[2].name = "camera1";
  const std::string message = error();
  EXPECT_THAT(message, HasSubstr("scenario.toml:18: the UAV 'uav1' has no sensor 'camera'"));
  EXPECT_THAT(message, HasSubstr("did you mean 'camera1'?"));
}

TEST_F(ResolveSensors, AMetricOfASensorThatTheUavLacksIsAnErrorAtItsLine) {
  scenario_.metrics.back().sensor = "rang";
  const std::string message = error();
  EXPECT_THAT(message, HasSubstr("scenario.toml:99: the UAV 'uav1' has no sensor 'rang'"));
  EXPECT_THAT(message, HasSubstr("did you mean 'range'?"));
}

TEST_F(ResolveSensors, AKeyThatMeansNothingToTheSensorIsAnErrorAtItsLine) {
  scenario_ = load_scenario(write_project(
      scratch_, replaced(kFullScenario, "period_ms = 50", "period_ms = 50\nmax_m = 3")));
  EXPECT_THAT(error(), HasSubstr("scenario.toml:27: 'max_m' goes with the kind \"range\", but the "
                                 "sensor 'imu' is of the kind \"imu\""));
}

TEST_F(ResolveSensors, AnotherKindThanTheSensorsIsAnErrorAtItsLine) {
  scenario_ = load_scenario(write_project(
      scratch_, replaced(kFullScenario, "period_ms = 50", "period_ms = 50\nkind = \"camera\"")));
  EXPECT_THAT(error(), HasSubstr("scenario.toml:27: 'kind' is \"camera\", but the sensor 'imu' of "
                                 "the UAV 'uav1' is of the kind \"imu\""));
}

}  // namespace
}  // namespace tether::scenario
