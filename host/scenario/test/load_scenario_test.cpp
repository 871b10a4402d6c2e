#include "full_scenario.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base/units.h>
#include <tether/scenario/scenario.h>

namespace tether::scenario {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

class LoadScenario : public testing::Test {
 protected:
  Scenario load(const std::string& text) const {
    return load_scenario(write_project(scratch_, text));
  }
  Scenario load_with(const std::string& from, const std::string& to) const {
    return load(replaced(kFullScenario, from, to));
  }
  std::string error_with(const std::string& from, const std::string& to) const {
    return bad_file_message([&] { load_with(from, to); });
  }
  ScratchFolder scratch_;
  const std::string mission_ = scratch_.path("missions/around.toml");
};

TEST_F(LoadScenario, ReadsTheTop) {
  const Scenario s = load(kFullScenario);
  EXPECT_EQ(s.file, scratch_.path("scenario.toml"));
  EXPECT_EQ(s.name, "full");
  EXPECT_EQ(s.description, "every key");
  EXPECT_EQ(s.world, scratch_.path("worlds/room.sdf"));
  EXPECT_EQ(s.step, milliseconds(2));
  EXPECT_EQ(s.time_limit, seconds(60));
  EXPECT_EQ(s.hang_limit, milliseconds(12'500));
  EXPECT_THAT(s.anchors, ElementsAre("blue_box", "red_box"));
  EXPECT_EQ(s.ground_truth_period, milliseconds(20));
  EXPECT_TRUE(s.record_images);
  EXPECT_EQ(s.image_period, milliseconds(500));
}

TEST_F(LoadScenario, ReadsUavs) {
  const Scenario s = load(kFullScenario);
  ASSERT_EQ(s.uavs.size(), 2u);
  EXPECT_EQ(s.uavs[0].placement.name, "uav1");
  EXPECT_EQ(s.uavs[0].placement.model, scratch_.path("models/uav.sdf"));
  EXPECT_EQ(s.uavs[0].placement.p_WB, (uav::Vec3{1.0, -2.5, 1.2}));
  EXPECT_DOUBLE_EQ(s.uavs[0].placement.yaw_rad, rad_from_deg(90));
  EXPECT_EQ(s.uavs[0].command_latency, milliseconds(5));
  EXPECT_EQ(s.uavs[1].placement.yaw_rad, 0.0);
  EXPECT_TRUE(s.uavs[1].sensors.empty());
}

TEST_F(LoadScenario, ReadsSensorTimings) {
  const Scenario s = load(kFullScenario);
  const auto& sensors = s.uavs[0].sensors;
  const auto& camera = std::get<uav::PeriodicTiming>(*sensors.at("camera").timing);
  EXPECT_EQ(camera.period, Duration(33'333'333));
  EXPECT_EQ(camera.phase, milliseconds(3));
  EXPECT_EQ(std::get<uav::ConstantDelay>(camera.delay).value, Duration(37'400'000));
  const auto& imu = std::get<uav::PeriodicTiming>(*sensors.at("imu").timing);
  EXPECT_EQ(imu.period, milliseconds(50));
  EXPECT_EQ(std::get<uav::NormalDelay>(imu.delay).mean, milliseconds(4));
  EXPECT_EQ(std::get<uav::NormalDelay>(imu.delay).stddev, Duration(1'500'000));
  const auto& range = std::get<uav::OnDemandTiming>(*sensors.at("range").timing);
  EXPECT_THAT(std::get<uav::EmpiricalDelay>(range.delay).samples,
              ElementsAre(milliseconds(10), milliseconds(20), Duration(30'500'000)));
}

TEST_F(LoadScenario, ReadsProfiles) {
  const Scenario s = load(kFullScenario);
  ASSERT_TRUE(s.uavs[0].profile);
  EXPECT_EQ(s.uavs[0].profile->name, "rig");
  EXPECT_EQ(s.uavs[0].profile->file, scratch_.path("profiles/rig.toml"));
  EXPECT_FALSE(s.uavs[1].profile);
  EXPECT_TRUE(s.conditions[0].profiles.empty());
  ASSERT_EQ(s.conditions[2].profiles.size(), 1u);
  EXPECT_EQ(s.conditions[2].profiles[0].name, "fog");
}

TEST_F(LoadScenario, NamesTheProfileThatIsWrong) {
  EXPECT_THAT(error_with("profiles/fog.toml", "profiles/frog.toml"),
              HasSubstr("'profile' of [condition] names \"profiles/frog.toml\", but there is no"));
  EXPECT_THAT(error_with("profiles/rig.toml", "delays.txt"),
              HasSubstr("delays.txt:1: no valid TOML"));
}

TEST_F(LoadScenario, LaysAProfileOnTopUnderEachCondition) {
  Scenario s = load(kFullScenario);
  const auto file = scratch_.write("top.toml", replaced(kRigProfile, "\"rig\"", "\"top\""));
  lay_profile(s, load_profile(file));
  EXPECT_THAT(profile_names(s, s.conditions[0]), ElementsAre("rig", "top"));
  EXPECT_THAT(profile_names(s, s.conditions[2]), ElementsAre("rig", "fog", "top"));
  EXPECT_THAT(s.files, testing::Contains(file));
  EXPECT_TRUE(std::is_sorted(s.files.begin(), s.files.end()));
  s.uavs[1].profile = s.uavs[0].profile;
  EXPECT_THAT(profile_names(s, s.conditions[0]), ElementsAre("rig", "top"));
  lay_profile(s, *s.uavs[0].profile);
  EXPECT_THAT(profile_names(s, s.conditions[2]), ElementsAre("fog", "top", "rig"))
      << "once, where it is topmost";
}

TEST_F(LoadScenario, GivesEachUavItsSut) {
  const Scenario s = load(kFullScenario);
  EXPECT_THAT(s.uavs[0].sut.command, ElementsAre("own-sut", "--fast"));
  EXPECT_THAT(s.uavs[0].sut.parameters, ElementsAre(Pair("anchor", "red_box")));
  EXPECT_THAT(s.uavs[1].sut.command, ElementsAre("tether-sut", "face-anchor"));
  EXPECT_THAT(
      s.uavs[1].sut.parameters,
      ElementsAre(Pair("anchor", "blue_box"), Pair("mission", mission_),
                  Pair("precision_deg", "2.5"), Pair("retries", "3"), Pair("verbose", "true")));
}

TEST_F(LoadScenario, TellsAProgramOfSeveralThreadsFromASerialOne) {
  const std::string common = "command = [\"tether-sut\", \"face-anchor\"]\n";
  EXPECT_FALSE(load(kFullScenario).uavs[1].sut.concurrent);
  const Scenario s = load_with(common, common + "concurrent = true\n");
  EXPECT_TRUE(s.uavs[1].sut.concurrent);
  EXPECT_FALSE(s.uavs[0].sut.concurrent) << "it has a command of its own";
}

TEST_F(LoadScenario, LaysOwnParametersOverTheCommonOnesWhenTheCommandIsCommon) {
  const Scenario s = load_with("command = [\"own-sut\", \"--fast\"]\n", "");
  EXPECT_THAT(s.uavs[0].sut.command, ElementsAre("tether-sut", "face-anchor"));
  EXPECT_THAT(
      s.uavs[0].sut.parameters,
      ElementsAre(Pair("anchor", "red_box"), Pair("mission", mission_),
                  Pair("precision_deg", "2.5"), Pair("retries", "3"), Pair("verbose", "true")));
}

TEST_F(LoadScenario, GivesASutItsFilesByTheirWholePath) {
  const std::string own = scratch_.write("own.toml", "");
  const Scenario s = load_with("[uav.sut.parameters]\nanchor = \"red_box\"",
                               "[uav.sut.files]\nmission = \"missions/../own.toml\"");
  EXPECT_THAT(s.uavs[0].sut.parameters, ElementsAre(Pair("mission", own)));
  EXPECT_THAT(s.uavs[1].sut.parameters, testing::Contains(Pair("mission", mission_)));
  EXPECT_THAT(s.files, testing::IsSupersetOf({own, mission_}));
}

TEST_F(LoadScenario, RefusesFilesThatASutCannotBeGiven) {
  const std::string mission = "mission = \"missions/around.toml\"";
  EXPECT_THAT(error_with(mission, "mission = \"missions/none.toml\""),
              HasSubstr("scenario.toml:54: 'mission' of [sut.files] names \"missions/none.toml\", "
                        "but there is no such file"));
  EXPECT_THAT(error_with(mission, "mission = \"missions\""), HasSubstr("no regular file"));
  EXPECT_THAT(error_with(mission, "Mission = \"missions/around.toml\""),
              HasSubstr("option of the SUT's command"));
  EXPECT_THAT(error_with(mission, "anchor = \"missions/around.toml\""),
              HasSubstr("'anchor' of [sut.files] is one of the parameters already"));
}

TEST_F(LoadScenario, ReadsConditions) {
  const Scenario s = load(kFullScenario);
  ASSERT_EQ(s.conditions.size(), 4u);
  EXPECT_EQ(s.conditions[0].policy, Policy::kConservativeBarrier);
  EXPECT_EQ(s.conditions[0].clock, Clock::kCpu);
  EXPECT_EQ(s.conditions[0].cpu_factor, 1.5);
  EXPECT_EQ(s.conditions[0].computing, Duration(0));
  EXPECT_EQ(s.conditions[0].real_time_factor, 0.0);
  const Condition* no_sync = s.find_condition("target, no sync");
  ASSERT_NE(no_sync, nullptr);
  EXPECT_EQ(no_sync->policy, Policy::kFreeRunning);
  EXPECT_EQ(no_sync->clock, Clock::kWall);
  EXPECT_EQ(no_sync->real_time_factor, 0.25);
  EXPECT_EQ(s.conditions[2].clock, Clock::kScripted);
  EXPECT_EQ(s.conditions[2].computing, Duration(2'500'000));
  EXPECT_EQ(s.find_condition("nowhere"), nullptr);
}

TEST_F(LoadScenario, ReadsTheTargetOfACondition) {
  const Scenario s = load(kFullScenario);
  EXPECT_FALSE(s.conditions[0].target);
  ASSERT_TRUE(s.conditions[3].target);
  EXPECT_EQ(s.conditions[3].target->name, "slow");
  EXPECT_EQ(s.conditions[3].clock, Clock::kCpu);
  EXPECT_EQ(s.conditions[3].cpu_factor, 6.0);
}

TEST_F(LoadScenario, ReadsTheSimulatorOfACondition) {
  const Scenario s = load(kFullScenario);
  EXPECT_EQ(s.conditions[0].simulator, "mujoco");
  EXPECT_EQ(s.conditions[3].simulator, "gazebo");
  EXPECT_THAT(error_with("simulator = \"gazebo\"", "simulator = \"gazeebo\""),
              HasSubstr("'simulator' of [condition] is \"gazeebo\"; did you mean 'gazebo'?"));
}

TEST_F(LoadScenario, LeavesTheClockToTheTarget) {
  const std::string target = "target = \"profiles/targets/slow.toml\"";
  for (const std::string key : {"clock = \"cpu\"", "cpu_factor = 2", "computing_ms = 2"}) {
    const std::string name = key.substr(0, key.find(' '));
    EXPECT_THAT(
        error_with(target, target + "\n" + key),
        HasSubstr("scenario.toml:80: '" + name + "' of [condition] is the target's to say"));
  }
  EXPECT_THAT(error_with("clock = \"wall\"", target + "\nclock = \"wall\""),
              HasSubstr("is the target's to say"));
  EXPECT_THAT(error_with(target, ""),
              HasSubstr("[condition] lacks the key 'clock', or a 'target'"));
}

TEST_F(LoadScenario, NamesTheTargetThatIsWrong) {
  EXPECT_THAT(error_with("targets/slow.toml", "targets/slaw.toml"),
              HasSubstr("scenario.toml:79: 'target' of [condition] names "
                        "\"profiles/targets/slaw.toml\", but there is no such file"));
  EXPECT_THAT(error_with("targets/slow.toml", "fog.toml"),
              HasSubstr("fog.toml:3: unknown key 'sensors' in the file"));
}

TEST_F(LoadScenario, RefusesATargetThatItsPolicyCannotHave) {
  scratch_.write("scaled.toml", "name = \"scaled\"\nclock = \"wall\"\ncpu_factor = 2\n");
  EXPECT_THAT(error_with("clock = \"wall\"", "target = \"scaled.toml\""),
              HasSubstr("scenario.toml:66: 'target' of [condition] cannot be used here: the target "
                        "\"scaled\" scales the wall clock"));
}

TEST_F(LoadScenario, ReadsMetrics) {
  const Scenario s = load(kFullScenario);
  ASSERT_EQ(s.metrics.size(), 3u);
  EXPECT_EQ(s.metrics[0].name, "time_required");
  EXPECT_EQ(s.metrics[0].label, "Time required");
  EXPECT_EQ(s.metrics[0].unit, "s");
  EXPECT_EQ(s.metrics[0].max, 30.0);
  EXPECT_EQ(s.metrics[0].anchor, "");
  EXPECT_EQ(s.metrics[1].name, "swings");
  EXPECT_EQ(s.metrics[1].kind, "oscillations");
  EXPECT_EQ(s.metrics[1].label, "Swings");
  EXPECT_EQ(s.metrics[1].uav, "uav2");
  EXPECT_EQ(s.metrics[1].anchor, "red_box");
  EXPECT_DOUBLE_EQ(s.metrics[1].threshold_rad, rad_from_deg(2));
  EXPECT_EQ(s.metrics[1].max, 0.0);
  EXPECT_EQ(s.metrics[1].sensor, "");
  EXPECT_EQ(s.metrics[2].kind, "acquisition_time");
  EXPECT_EQ(s.metrics[2].sensor, "camera");
}

TEST_F(LoadScenario, ListsEveryFileItRestsOn) {
  EXPECT_THAT(
      load(kFullScenario).files,
      ElementsAre(scratch_.path("delays.txt"), mission_, scratch_.path("models/uav.sdf"),
                  scratch_.path("profiles/fog.toml"), scratch_.path("profiles/fog.txt"),
                  scratch_.path("profiles/rig.toml"), scratch_.path("profiles/targets/slow.toml"),
                  scratch_.path("scenario.toml"), scratch_.path("worlds/room.sdf")));
}

TEST_F(LoadScenario, ResolvesAProgramInAFolderAgainstTheScenario) {
  const Scenario s = load_with("[\"tether-sut\", ", "[\"./bin/sut\", ");
  EXPECT_EQ(s.uavs[1].sut.command.front(), scratch_.path("bin/sut"));
}

TEST_F(LoadScenario, TakesAProgramThatIsOnABoardOnly) {
  const Scenario s = load_with("[\"tether-sut\", ", "[\"/opt/onboard/none\", ");
  EXPECT_EQ(s.uavs[1].sut.command.front(), "/opt/onboard/none");
}

TEST_F(LoadScenario, RefusesTetherExecUnderTetherExec) {
  const auto error = [&](const std::string& program) {
    return error_with("command = [\"tether-sut\", ",
                      "concurrent = true\ncommand = [\"" + program + "\", ");
  };
  for (const std::string program : {"tether-exec", "/usr/bin/tether-exec"})
    EXPECT_THAT(error(program),
                HasSubstr("'concurrent' of [sut] has the command started under tether-exec "
                          "already; leave the word \"tether-exec\""));
}

TEST_F(LoadScenario, SuggestsTheKeyThatWasMeant) {
  EXPECT_THAT(error_with("anchors =", "anchor ="),
              HasSubstr("scenario.toml:7: unknown key 'anchor' in the file; did you mean "
                        "'anchors'?"));
  EXPECT_THAT(error_with("step_ms = 2", "step_s = 0.002"), HasSubstr("did you mean 'step_ms'?"));
  EXPECT_THAT(error_with("rate_hz = 30", "rate = 30"), HasSubstr("did you mean 'rate_hz'?"));
  EXPECT_THAT(error_with("mean_ms = 4", "mean = 4"), HasSubstr("did you mean 'mean_ms'?"));
}

TEST_F(LoadScenario, SuggestsTheWordThatWasMeant) {
  EXPECT_THAT(error_with("\"conservative_barrier\"", "\"conservative\""),
              HasSubstr("'policy' of [condition] is \"conservative\"; did you mean "
                        "'conservative_barrier'? Allowed: 'conservative_barrier' and "
                        "'free_running'"));
  EXPECT_THAT(error_with("\"oscillations\"", "\"oscilations\""),
              HasSubstr("did you mean 'oscillations'?"));
  EXPECT_THAT(error_with("anchor = \"red_box\"\nthreshold", "anchor = \"rd_box\"\nthreshold"),
              HasSubstr("did you mean 'red_box'?"));
}

TEST_F(LoadScenario, SaysWhatItFoundAndWhatIsAllowed) {
  EXPECT_THAT(
      error_with("time_limit_s = 60", "time_limit_s = \"60\""),
      HasSubstr(":5: 'time_limit_s' of the file must be a number, but is the string \"60\""));
  EXPECT_THAT(error_with("cpu_factor = 1.5", "cpu_factor = -1"),
              HasSubstr("must be at least 0.001 and at most 10000, but is -1"));
  EXPECT_THAT(error_with("time_limit_s = 60", "time_limit_s = nan"), HasSubstr("but is nan"));
  EXPECT_THAT(error_with("position_m = [1, -2.5, 1.2]", "position_m = [1, 2]"),
              HasSubstr("must be an array of 3 numbers, but has 2 elements"));
}

TEST_F(LoadScenario, NamesAMissingFileAndWhereItLooked) {
  const std::string message = error_with("worlds/room.sdf", "worlds/rom.sdf");
  EXPECT_THAT(message, HasSubstr("scenario.toml:3: 'world' of the file names \"worlds/rom.sdf\""));
  EXPECT_THAT(message, HasSubstr(scratch_.path("worlds/rom.sdf").string()));
}

TEST_F(LoadScenario, NamesTheLineOfASyntaxError) {
  EXPECT_THAT(error_with("yaw_deg = 90", "yaw_deg = = 90"),
              HasSubstr("scenario.toml:13: no valid TOML"));
}

TEST_F(LoadScenario, RefusesWhatIsNoFile) {
  EXPECT_THAT(bad_file_message([&] { load_scenario(scratch_.path("none.toml")); }),
              HasSubstr("no such file"));
  EXPECT_THAT(bad_file_message([&] { load_scenario(scratch_.path()); }),
              HasSubstr("no regular file"));
  EXPECT_THAT(bad_file_message([&] { load(std::string((1 << 20) + 1, '#')); }),
              HasSubstr("at most 1048576 are read"));
}

TEST_F(LoadScenario, RefusesNamesThatCollide) {
  EXPECT_THAT(error_with("name = \"uav2\"", "name = \"uav1\""), HasSubstr("another UAV"));
  EXPECT_THAT(error_with("name = \"target, no sync\"", "name = \"Host!\""),
              HasSubstr("too like the condition \"host\""));
  EXPECT_THAT(error_with("name = \"swings\"", "name = \"time_required\""),
              HasSubstr("a second metric \"time_required\""));
  EXPECT_THAT(error_with("\"red_box\"]", "\"blue_box\"]"), HasSubstr("one anchor twice"));
}

TEST_F(LoadScenario, RefusesNamesThatAreNoFileNames) {
  for (const std::string name : {"../up", "a/b", ".hidden", "white space", ""}) {
    EXPECT_THAT(error_with("name = \"full\"", "name = \"" + name + "\""), HasSubstr(":1: 'name'"));
  }
}

TEST_F(LoadScenario, RefusesSettingsThatMeanNothingTogether) {
  EXPECT_THAT(error_with("real_time_factor = 0.25", ""), HasSubstr("lacks the key 'real_time"));
  EXPECT_THAT(error_with("real_time_factor = 0.25", "real_time_factor = 0.25\ncpu_factor = 2"),
              HasSubstr("needs clock = \"cpu\""));
  EXPECT_THAT(error_with("cpu_factor = 1.5", "computing_ms = 2"),
              HasSubstr("needs clock = \"scripted\""));
  EXPECT_THAT(error_with("computing_ms = 2.5", ""), HasSubstr("lacks the key 'computing_ms'"));
  EXPECT_THAT(error_with("computing_ms = 2.5", "computing_ms = 0"), HasSubstr("at least 0.001"));
  EXPECT_THAT(error_with("computing_ms = 2.5", "computing_ms = 2.5\ncpu_factor = 2"),
              HasSubstr("needs clock = \"cpu\""));
  EXPECT_THAT(error_with("clock = \"wall\"", "clock = \"scripted\"\ncomputing_ms = 1"),
              HasSubstr("needs policy = \"conservative_barrier\""));
  EXPECT_THAT(error_with("max_s = 30", "sensor = \"camera\""), HasSubstr("means nothing"));
  EXPECT_THAT(error_with("sensor = \"camera\"", ""), HasSubstr("'sensor'"));
  EXPECT_THAT(error_with("rate_hz = 30", "rate_hz = 30\nperiod_ms = 5"),
              HasSubstr("either 'rate_hz' or 'period_ms'"));
  EXPECT_THAT(error_with("max_s = 30", "max_m = 30"), HasSubstr("did you mean 'max_s'?"));
  EXPECT_THAT(error_with("max_s = 30", "threshold_deg = 1"), HasSubstr("means nothing"));
  EXPECT_THAT(error_with("ground_truth_period_ms = 20", "ground_truth_period_ms = 1"),
              HasSubstr("at least 2"));
  EXPECT_THAT(error_with("timing = \"on_demand\"", "timing = \"on_demand\"\nrate_hz = 5"),
              HasSubstr("scenario.toml:31: 'rate_hz' of [uav.sensors.range] goes with timing = "
                        "\"periodic\", but the timing is \"on_demand\""));
  EXPECT_THAT(error_with("timing = \"periodic\"\nrate_hz = 30", "rate_hz = 30"),
              HasSubstr("scenario.toml:18: [uav.sensors.camera] lacks the key 'timing': 'rate_hz' "
                        "goes with"));
}

TEST_F(LoadScenario, RefusesAUavWithoutSut) {
  const std::string sut =
      "[sut]\ncommand = [\"tether-sut\", \"face-anchor\"]\n\n[sut.parameters]\n"
      "anchor = \"blue_box\"\nprecision_deg = 2.5\nretries = 3\nverbose = true\n\n[sut.files]\n"
      "mission = \"missions/around.toml\"\n";
  EXPECT_THAT(error_with(sut, ""), HasSubstr("scenario.toml:39: [uav] has no SUT"));
}

TEST_F(LoadScenario, RefusesParametersThatAreNoOptions) {
  EXPECT_THAT(error_with("retries = 3", "\"--x\" = 3"), HasSubstr("option of the SUT's command"));
  EXPECT_THAT(error_with("retries = 3", "retries = [3]"), HasSubstr("but is an array"));
  EXPECT_THAT(error_with("retries = 3", "retries = \"a\\u0000b\""), HasSubstr("NUL"));
}

TEST_F(LoadScenario, TakesTheOnlyUavAndTheOnlyAnchorAsDefaults) {
  const Scenario s = load(R"(name = "small"
world = "worlds/room.sdf"
time_limit_s = 10
anchors = ["blue_box"]
[[uav]]
name = "uav1"
model = "models/uav.sdf"
position_m = [0, 0, 1]
[sut]
command = ["tether-sut"]
[[condition]]
name = "host"
policy = "conservative_barrier"
clock = "cpu"
[[metric]]
kind = "oscillations"
)");
  EXPECT_EQ(s.metrics[0].uav, "uav1");
  EXPECT_EQ(s.metrics[0].anchor, "blue_box");
  EXPECT_DOUBLE_EQ(s.metrics[0].threshold_rad, rad_from_deg(1));
  EXPECT_EQ(s.step, milliseconds(1));
  EXPECT_FALSE(s.record_images);
}

TEST(Slug, IsAFileName) {
  EXPECT_EQ(slug("target, no sync"), "target-no-sync");
  EXPECT_EQ(slug("  Host (1)  "), "host-1");
  EXPECT_EQ(slug("../.."), "");
}

}  // namespace
}  // namespace tether::scenario
