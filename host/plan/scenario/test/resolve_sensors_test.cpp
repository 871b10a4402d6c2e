#include "sensor_world.h"
#include "test_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/scenario/scenario.h>

namespace tether::scenario {
namespace {

using std::chrono::milliseconds;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

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
                           [&](const Warning& warning) { warnings_.push_back(to_line(warning)); });
  }
  void expect_refused(int line, const std::string& subject) {
    expect_refusal(line, subject, [&] { (void)resolve(); });
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

TEST_F(ResolveSensors, TimingsAreInTheOrderOfTheWorldsSensors) {
  const auto timings = resolve();
  ASSERT_EQ(timings.size(), 2u);
  ASSERT_EQ(timings[0].size(), 3u);
  EXPECT_TRUE(std::holds_alternative<uav::OnDemandTiming>(timings[0][0]));
  EXPECT_EQ(std::get<uav::PeriodicTiming>(timings[0][1]).period, milliseconds(50));
  EXPECT_EQ(std::get<uav::PeriodicTiming>(timings[0][2]).phase, milliseconds(3));
  EXPECT_EQ(std::get<uav::PeriodicTiming>(timings[1][0]).period, milliseconds(50)) << "as in SDF";
  EXPECT_TRUE(std::holds_alternative<uav::OnDemandTiming>(timings[1][1])) << "as in SDF";
}

// The step.

TEST_F(ResolveSensors, RefusesARateThatMeasuresTwiceInAStep) {
  world_.step = milliseconds(2);
  world_.step_at = {"/w.sdf", 4};
  world_.uavs[1].sensors[0] = make_imu("imu", 1000.0);
  world_.uavs[1].sensors[0].declared_at = {"/uav.sdf", 9};
  const Error error = bad_file_error([&] { (void)resolve(); });
  EXPECT_EQ(error.where(), (FileLocation{"/uav.sdf", 9}));
  EXPECT_THAT(error.what(), HasSubstr("measures every 1 ms, but a step is 2 ms (set at /w.sdf:4)"));
  world_.step = milliseconds(1);
  EXPECT_NO_THROW((void)resolve());
}

TEST_F(ResolveSensors, WarnsOfARateThatTheStepMakesUnsteady) {
  world_.uavs[1].sensors[0] = make_imu("imu", 400.0);
  (void)resolve();
  EXPECT_THAT(warnings_, testing::Contains(HasSubstr("varies by 1 ms")));
  warnings_.clear();
  world_.uavs[1].sensors[0] = make_imu("imu", 250.0);
  (void)resolve();
  world_.uavs[1].sensors[0] = make_imu("imu", 60.0);
  (void)resolve();
  EXPECT_THAT(warnings_, testing::Not(testing::Contains(HasSubstr("varies"))));
}

TEST_F(ResolveSensors, WarnsOfASensorThatLosesHalfOfItsMeasurements) {
  lay("good.toml", "[sensors.range]\nkind = \"range\"\ndropout_probability = 0.4\n");
  (void)resolve();
  EXPECT_THAT(warnings_, testing::Not(testing::Contains(HasSubstr("loses"))));
  lay("dead.toml", "[sensors.range]\nkind = \"range\"\ndropout_probability = 1\n");
  (void)resolve();
  EXPECT_THAT(warnings_, testing::Contains(AllOf(HasSubstr("sensor 'range' of UAV 'uav1'"),
                                                 HasSubstr("loses 100 % of its measurements"))));
}

TEST_F(ResolveSensors, WarnsOfAReceiverWithoutAFixInHalfOfItsMeasurements) {
  sim::Sensor navsat = make_range("navsat");
  navsat.model = sim::NavSatModel();
  world_.uavs[0].sensors.push_back(navsat);
  const std::string often = "[sensors.navsat]\nkind = \"navsat\"\noutage_every_s = 2.0\n";
  lay("seldom.toml", often + "outage_lasts_s = 0.9\n");
  (void)resolve();
  EXPECT_THAT(warnings_, testing::Not(testing::Contains(HasSubstr("fix"))));
  lay("often.toml", often + "outage_lasts_s = 1.9\n");
  (void)resolve();
  EXPECT_THAT(warnings_, testing::Contains(AllOf(HasSubstr("sensor 'navsat' of UAV 'uav1'"),
                                                 HasSubstr("has no fix in 95 % of its"))));
}

TEST_F(ResolveSensors, WarnsOfASensorWhoseFirstMeasurementIsAfterTheFlight) {
  scenario_.time_limit = std::chrono::seconds(20);
  lay("late.toml",
      "[sensors.range]\nkind = \"range\"\ntiming = \"periodic\"\nrate_hz = 10\n"
      "phase_ms = 20000\n");
  (void)resolve();
  EXPECT_THAT(warnings_, testing::Contains(HasSubstr("its first measurement is at 20 s")));
}

TEST_F(ResolveSensors, TakesTheScenariosStepElseTheWorlds) {
  world_.step = milliseconds(4);
  world_.step_from = "world";
  resolve_step(scenario_, world_);
  EXPECT_EQ(world_.step, milliseconds(2));
  EXPECT_EQ(world_.step_from, "scenario");
  EXPECT_EQ(world_.step_at.file, scenario_.file);
  scenario_.step.reset();
  world_.step = milliseconds(30);
  const Error error = bad_file_error([&] { resolve_step(scenario_, world_); });
  EXPECT_EQ(error.subject(), "ground_truth_period_ms");
  EXPECT_EQ(error.where().line, 102);
  world_.step = milliseconds(20);
  resolve_step(scenario_, world_);
  EXPECT_EQ(world_.step, milliseconds(20));
}

// Layers.

TEST_F(ResolveSensors, ALaterLayerOverridesAnEarlierOne) {
  const std::string range = "[sensors.range]\nkind = \"range\"\nmax_m = ";
  scenario_.uavs[0].profile =
      load_profile(scratch_.write("below.toml", "name = \"b\"\n" + range + "1\n"));
  resolve();
  EXPECT_EQ(max_m(0, 0), 1.0);
  EXPECT_EQ(max_m(1, 1), 4.0);

  scenario_.uavs[0].sensors.at("range").settings.push_back(
      {uav::SensorKind::kRange,
       [](sim::Sensor& s) { std::get<sim::RangeModel>(s.model).max_m = 2.0; }});
  resolve();
  EXPECT_EQ(max_m(0, 0), 2.0);

  resolve("scripted");  // has "fog", for all UAVs
  EXPECT_EQ(max_m(0, 0), 3.0);
  EXPECT_EQ(max_m(1, 1), 3.0);

  lay("top.toml", range + "5\n");
  resolve("scripted");
  EXPECT_EQ(max_m(0, 0), 5.0);
  EXPECT_EQ(max_m(1, 1), 5.0);
  EXPECT_THAT(warnings_, testing::IsEmpty());
}

TEST_F(ResolveSensors, ALayerKeepsWhatItDoesNotSet) {
  const auto timings = resolve("scripted");
  EXPECT_TRUE(std::holds_alternative<uav::PeriodicTiming>(timings[0][2])) << "of the scenario";
  EXPECT_EQ(std::get<sim::CameraModel>(sensor(0, 2).model).pixel_noise.stddev, 0.02)
      << "of the UAV's profile";
  EXPECT_THAT(
      std::get<uav::EmpiricalDelay>(std::get<uav::OnDemandTiming>(timings[0][0]).delay).samples,
      ElementsAre(milliseconds(90), milliseconds(110)))
      << "of the condition's profile";
}

// The sensor to which an entry of a profile applies.

TEST_F(ResolveSensors, AnEntryAppliesToTheSensorOfItsNameAndKindOrTheOnlyOneOfItsKind) {
  world_.uavs[1].sensors.push_back(make_range("camera"));
  lay("p.toml", "[sensors.camera]\nkind = \"range\"\nmax_m = 2\n");
  resolve();
  EXPECT_EQ(max_m(0, 0), 2.0) << "its camera is of another kind";
  EXPECT_EQ(max_m(1, 1), 4.0);
  EXPECT_EQ(max_m(1, 2), 2.0);
}

TEST_F(ResolveSensors, RefusesClausesAboutSensorsThatTheUavLacks) {
  const auto fly = [&](std::size_t uav, const std::string& condition) {
    const auto file =
        scratch_.write("mission.toml", "[[task]]\ntask = \"land\"\n\n[[clause]]\nalways = \"" +
                                           condition + " <= 1 s\"\n");
    scenario_.uavs[uav].sut.mission = mission::load_mission(file);
  };
  for (const char* known : {"reaction_time", "reaction_time of camera", "data_age of range"}) {
    fly(0, known);
    EXPECT_NO_THROW((void)resolve()) << known;
  }
  fly(0, "loop_period of nose");
  expect_refused(4, "nose");
  fly(0, "reaction_time of imu");
  expect_refused(4, "mission: always reaction_time of imu <= 1 s");
  scenario_.uavs[0].sut.mission.reset();
  fly(1, "reaction_time");
  expect_refused(4, "mission: always reaction_time <= 1 s");
}

TEST_F(ResolveSensors, WarnsOfAKindThatTheUavLacks) {
  lay("p.toml", "[sensors.front]\nkind = \"camera\"\nnoise = {}\n");
  resolve();
  EXPECT_THAT(warnings_, ElementsAre(AllOf(StartsWith(scratch_.path("p.toml").string() + ":2: "),
                                           HasSubstr("'uav2'"), HasSubstr("[sensors.front]"))));
}

TEST_F(ResolveSensors, ANamedSensorMatchesNoOtherEntry) {
  lay("p.toml",
      "[sensors.down]\nkind = \"range\"\nmax_m = 1\n"
      "[sensors.range]\nkind = \"range\"\nmax_m = 2\n");
  resolve();
  EXPECT_EQ(max_m(0, 0), 2.0);
  EXPECT_EQ(max_m(1, 1), 2.0);
  const auto warning = [&](const std::string& uav) {
    return AllOf(StartsWith(scratch_.path("p.toml").string() + ":2: "), HasSubstr(uav),
                 HasSubstr("[sensors.range] (line 5)"), HasSubstr("[sensors.down]"));
  };
  EXPECT_THAT(warnings_, ElementsAre(warning("'uav1'"), warning("'uav2'")));
}

TEST_F(ResolveSensors, RefusesTwoEntriesForOneSensor) {
  lay("p.toml", "[sensors.a]\nkind = \"imu\"\n[sensors.b]\nkind = \"imu\"\n");
  expect_refused(4, "b");
}

TEST_F(ResolveSensors, RefusesAnEntryThatMatchesSeveralSensors) {
  world_.uavs[0].sensors.push_back(make_range("down"));
  lay("p.toml", "[sensors.front]\nkind = \"range\"\n");
  expect_refused(2, "front");
}

TEST_F(ResolveSensors, RefusesASensorThatTheUavLacksAtItsLine) {
  scenario_.metrics.back().sensor = "rang";
  expect_refused(99, "rang");
  world_.uavs[0].sensors[2].name = "camera1";
  expect_refused(18, "camera");
}

TEST_F(ResolveSensors, RefusesKeysOfAnotherKindAtTheirLine) {
  for (const auto& [line, key] : {std::pair{"max_m = 3", "max_m"}, {"kind = \"camera\"", "kind"}}) {
    scenario_ =
        load_scenario(write_project(scratch_, replaced(kFullScenario, "period_ms = 50",
                                                       std::string("period_ms = 50\n") + line)));
    expect_refused(27, key);
  }
}

}  // namespace
}  // namespace tether::scenario
