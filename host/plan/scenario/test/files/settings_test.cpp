#include "sensor_world.h"
#include "test_files.h"

#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/scenario/scenario.h>

namespace tether::scenario {
namespace {

class Settings : public testing::Test {
 protected:
  Scenario load(const std::vector<Setting>& settings) const {
    return load_scenario(write_project(scratch_, kFullScenario), settings);
  }
  ScratchFolder scratch_;
};

TEST_F(Settings, ReplaceValuesByTheirPathFromTheTopAConditionOrAUav) {
  EXPECT_EQ(load({{"time_limit_s", "70"}}).time_limit, std::chrono::seconds(70));
  EXPECT_EQ(load({{"condition.cpu_factor", "9"}}).find_condition("host")->computers[0].clock.factor,
            9);
  EXPECT_EQ(load({{"cpu_factor", "9"}}).find_condition("host")->computers[0].clock.factor, 9);
  EXPECT_EQ(load({{"yaw_spread_deg", "0"}}).uavs.front().yaw_spread_rad, 0.0);
}

TEST_F(Settings, AddKeysThatTheFileLacks) {
  EXPECT_EQ(load({{"connect_limit_s", "7"}}).connect_limit, std::chrono::seconds(7));
  EXPECT_EQ(load({{"max_contact_speed_m_s", "inf"}}).max_contact_speed_m_s,
            std::numeric_limits<double>::infinity());
  const Error wrong = bad_file_error([&] { load({{"connect_limit_s", "-7"}}); });
  EXPECT_THAT(wrong.what(), testing::StartsWith("--set connect_limit_s=-7: 'connect_limit_s'"));
  const Error error = bad_file_error([&] { load({{"condition.cpu_factr", "2"}}); });
  EXPECT_EQ(error.subject(), "cpu_factr");
}

TEST_F(Settings, OfTablesWithoutNamesSayHowToSetThem) {
  try {
    load({{"moving.platform.repeats", "true"}});
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("'moving.repeats' is that key of each"));
  }
}

TEST_F(Settings, ReplaceArrays) {
  EXPECT_THAT(load({{"uav.position_m", "[1, -2, 3.5]"}}).name,
              testing::EndsWith("-position_m-1--2-3.5"));
  EXPECT_EQ(load({{"uav.position_m", "[1, 2, 3.5]"}}).uavs.at(1).placement.p_WB,
            (uav::Vec3{1, 2, 3.5}));
  EXPECT_EQ(load({{"anchors", "[\"blue_box\", \"red_box\", \"tree\"]"}}).anchors.size(), 3u);
  EXPECT_EQ(bad_file_error([&] { load({{"uav.position_m", "[1, 2]"}}); }).subject(), "position_m");
}

TEST_F(Settings, AreInTheScenariosName) {
  const std::string name = load({}).name;
  EXPECT_EQ(load({{"time_limit_s", "70"}, {"condition.cpu_factor", "0.5"}}).name,
            name + "-time_limit_s-70-cpu_factor-0.5");
  const auto file = scratch_.write("far/other rig.toml", replaced(kRigProfile, "\"rig\"", "\"o\""));
  EXPECT_EQ(load({{"uav.profile", file.string()}}).name, name + "-profile-other-rig");
}

TEST_F(Settings, ReplaceValuesOfSensorsThatAProfileHas) {
  for (const std::string from : {"", "uav."}) {
    const std::string key = from + "sensors.camera.noise.stddev";
    const Scenario scenario = load({{key, "0.5"}});
    sim::Sensor camera = make_camera("camera");
    for (const auto& setting : scenario.uavs.front().profile->sensors.at("camera").settings)
      setting.set(camera);
    EXPECT_EQ(std::get<sim::CameraModel>(camera.model).pixel_noise.stddev, 0.5);
    const Error error = bad_file_error([&] { load({{key, "-1"}}); });
    EXPECT_EQ(error.subject(), "stddev");
    EXPECT_THAT(error.what(), testing::StartsWith("--set " + key + "=-1: 'stddev'"));
  }
}

TEST_F(Settings, MayBeNewKeysOfSensorsThatAProfileHas) {
  const Scenario scenario = load({{"sensors.camera.lost_probability", "0.25"}});
  sim::Sensor camera = make_camera("camera");
  for (const auto& setting : scenario.uavs.front().profile->sensors.at("camera").settings)
    setting.set(camera);
  EXPECT_EQ(camera.driver.lost_probability, 0.25);
  EXPECT_THAT(bad_file_error([&] {
                load({{"sensors.camera.nonsense", "1"}});
              }).what(),
              testing::StartsWith("--set sensors.camera.nonsense=1: unknown key 'nonsense'"));
}

TEST_F(Settings, NeedAKeyThatTheFileHas) {
  try {
    load({{"sut.parameters.nonsense", "1"}});
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kUsage);
    EXPECT_EQ(error.subject(), "sut.parameters.nonsense");
  }
}

TEST_F(Settings, AreCheckedAsTheFileWithoutItsLine) {
  const Error error = bad_file_error([&] { load({{"time_limit_s", "3s"}}); });
  EXPECT_EQ(error.subject(), "time_limit_s");
  EXPECT_EQ(error.where(), FileLocation{});
  EXPECT_STREQ(error.what(),
               "--set time_limit_s=3s: 'time_limit_s' of the file must be a number, but is the "
               "string \"3s\"");
}

TEST_F(Settings, AreNotNamedForAKeyThatIsWrongInTheFile) {
  const auto file = write_project(scratch_, replaced(kFullScenario, "step_ms = 2", "step_ms = 0"));
  const Error error = bad_file_error([&] { load_scenario(file, {{"uav.step_ms", "1"}}); });
  EXPECT_EQ(error.where(), (FileLocation{file, 4}));
}

TEST_F(Settings, AreKeyAndValueWithFilesAsAbsolutePaths) {
  const auto file = scratch_.write("p.toml", "");
  EXPECT_EQ(parse_setting("a.b=1=2", scratch_.path()), (Setting{"a.b", "1=2"}));
  EXPECT_EQ(parse_setting("uav.profile=p.toml", scratch_.path()),
            (Setting{"uav.profile", file.string()}));
  for (const char* text : {"", "a", "=1", "a="})
    EXPECT_THAT(
        thrown_error(ErrorCode::kUsage, [&] { parse_setting(text, scratch_.path()); }).what(),
        testing::StartsWith("--set"))
        << text;
}

}  // namespace
}  // namespace tether::scenario
