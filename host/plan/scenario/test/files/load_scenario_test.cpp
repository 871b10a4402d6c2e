#include "test_files.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base/units.h>
#include <tether/scenario/scenario.h>

namespace tether::scenario {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Key;
using testing::Pair;

class LoadScenario : public testing::Test {
 protected:
  Scenario load(const std::string& text) const {
    return load_scenario(write_project(scratch_, text));
  }
  Scenario load_with(const std::string& from, const std::string& to) const {
    return load(replaced(kFullScenario, from, to));
  }
  void expect_refused(const std::vector<WrongChange>& changes) const {
    for (const WrongChange& change : changes)
      expect_refusal(change.line, change.subject, [&] { load_with(change.from, change.to); });
  }
  ScratchFolder scratch_;
  const std::string mission_ = scratch_.path("missions/around.toml");
};

TEST_F(LoadScenario, ReadsWhatIsReplayed) {
  scratch_.write("a.timing", "");
  scratch_.write("b.timing", "");
  const std::string measured = "clock = \"cpu\"\ncpu_factor = 1.5";
  const std::string replayed = "clock = \"replayed\"\n";
  const std::string timing = replayed + "timing = \"a.timing\"\n";
  const auto change = [&](const std::string& keys) {
    return replaced(kFullScenario, measured, keys);
  };
  const auto source = [&](const std::string& keys) {
    const Scenario scenario = load(change(keys));
    EXPECT_EQ(scenario.conditions[0].computers[0].clock.kind, computer::ClockKind::kReplayed);
    EXPECT_EQ(std::ranges::count(scenario.files, scratch_.path("a.timing")), 1);
    return *scenario.conditions[0].replay;
  };
  EXPECT_EQ(source(timing).timing, scratch_.path("a.timing"));
  EXPECT_EQ(source(timing).mode, computer::ReplayMode::kResampled);
  EXPECT_EQ(source(timing + "mode = \"exact\"").mode, computer::ReplayMode::kExact);
  EXPECT_EQ(source(timing + "unknown_stages = \"zero\"").unknown, computer::UnknownStages::kZero);
  EXPECT_EQ(source(timing + "mode = \"scaled\"\ncounted = \"b.timing\"").counted,
            scratch_.path("b.timing"));
  for (const auto& [keys, line, subject] :
       {std::tuple(measured + "\nmode = \"exact\"", 2, "mode"),
        std::tuple(timing + "mode = \"scaled\"", 2, "mode"),
        std::tuple(timing + "mode = \"same\"", 2, "mode"),
        std::tuple(timing + "counted = \"b.timing\"", 2, "counted"),
        std::tuple(timing + "unknown_stages = \"counted\"", 2, "unknown_stages"),
        std::tuple(replayed + "timing = \"c.timing\"", 1, "timing"),
        std::tuple(timing + "mode = \"exact\"\nunknown_stages = \"zero\"", 3, "unknown_stages")})
    expect_refusal(60 + line, subject, [&, &keys = keys] { load(change(keys)); });
  expect_refusal(66, "clock", [&] { load_with("clock = \"wall\"", timing); });  // free running
}

TEST_F(LoadScenario, ChangesWhatUnknownStagesTake) {
  Condition condition;
  const auto refused = [&](const char* name) {
    return thrown_error(ErrorCode::kUsage, [&] { set_unknown_stages(condition, name); }).subject();
  };
  EXPECT_EQ(refused("zero"), "--unknown-stages");
  condition.replay.emplace();
  EXPECT_EQ(refused("nothing"), "--unknown-stages");
  EXPECT_EQ(refused("counted"), "--unknown-stages");
  set_unknown_stages(condition, "zero");
  EXPECT_EQ(condition.replay->unknown, computer::UnknownStages::kZero);
  condition.replay->mode = computer::ReplayMode::kExact;
  EXPECT_EQ(refused("zero"), "--unknown-stages");
}

TEST_F(LoadScenario, ReadsTheTop) {
  const Scenario s = load(kFullScenario);
  EXPECT_EQ(s.file, scratch_.path("scenario.toml"));
  EXPECT_EQ(s.name, "full");
  EXPECT_EQ(s.description, "every key");
  EXPECT_EQ(s.world, scratch_.path("worlds/room.sdf"));
  EXPECT_EQ(s.step, milliseconds(2));
  EXPECT_EQ(s.time_limit, seconds(60));
  EXPECT_EQ(s.hang_limit, milliseconds(12'500));
  EXPECT_EQ(s.connect_limit, seconds(30));
  EXPECT_EQ(load_with("step_ms = 2", "connect_limit_s = 7").connect_limit, seconds(7));
  EXPECT_EQ(s.anchors_at.line, 7);
  EXPECT_THAT(s.anchors, ElementsAre("blue_box", "red_box"));
  EXPECT_EQ(s.ground_truth_period, milliseconds(20));
  EXPECT_TRUE(s.record_images);
  EXPECT_EQ(s.image_period, milliseconds(500));
  EXPECT_THAT(
      s.files,
      ElementsAre(scratch_.path("delays.txt"), mission_, scratch_.path("models/uav.sdf"),
                  scratch_.path("profiles/fog.toml"), scratch_.path("profiles/fog.txt"),
                  scratch_.path("profiles/rig.toml"), scratch_.path("profiles/targets/slow.toml"),
                  scratch_.path("scenario.toml"), scratch_.path("worlds/room.sdf")));
}

TEST_F(LoadScenario, ReadsHowCommandsArriveAndWhatFollowsTheirLoss) {
  const std::string old = "command_latency_ms = 5";
  const std::string timeout = "setpoint_timeout_ms = 500\n";
  const Scenario s =
      load_with(old, timeout +
                         "on_setpoint_loss = \"land\"\n"
                         "command_latency = { kind = \"normal\", mean_ms = 5, stddev_ms = 2 }");
  EXPECT_EQ(std::get<uav::NormalDelay>(s.uavs[0].command_latency).stddev, milliseconds(2));
  EXPECT_EQ(s.uavs[0].setpoint_loss,
            (uav::SetpointLoss{milliseconds(500), uav::LossAction::kLand}));
  EXPECT_EQ(load_with(old, timeout).uavs[0].setpoint_loss->action, uav::LossAction::kKeep);
  expect_refused(
      {{old, "on_setpoint_loss = \"hover\"", 15, "on_setpoint_loss"},
       {old, timeout + "on_setpoint_loss = \"fall\"", 16, "on_setpoint_loss"},
       {old, "setpoint_timeout_ms = 0", 15, "setpoint_timeout_ms"},
       {old, "command_latency = 5", 15, "command_latency"},
       {old, old + "\ncommand_latency = { kind = \"constant\", ms = 1 }", 15, old.substr(0, 18)}});
}

TEST_F(LoadScenario, ReadsUavsWithTheirSensors) {
  const Scenario s = load(kFullScenario);
  ASSERT_EQ(s.uavs.size(), 2u);
  EXPECT_EQ(s.uavs[0].placement.name, "uav1");
  EXPECT_EQ(s.uavs[0].placement.model, scratch_.path("models/uav.sdf"));
  EXPECT_EQ(s.uavs[0].placement.p_WB, (uav::Vec3{1.0, -2.5, 1.2}));
  EXPECT_DOUBLE_EQ(s.uavs[0].placement.yaw_rad, rad_from_deg(90));
  EXPECT_EQ(mean(s.uavs[0].command_latency), milliseconds(5));
  EXPECT_EQ(s.uavs[0].setpoint_loss, std::nullopt);
  EXPECT_EQ(s.uavs[1].placement.yaw_rad, 0.0);
  EXPECT_TRUE(s.uavs[1].sensors.empty());
  EXPECT_THAT(s.uavs[0].sensors, ElementsAre(Key("camera"), Key("imu"), Key("range")));
  EXPECT_EQ(std::get<uav::PeriodicTiming>(*s.uavs[0].sensors.at("camera").timing).phase,
            milliseconds(3));
}

// Results tell profiles by their names: two of one name would look as if the sensors were the same.
TEST_F(LoadScenario, RefusesTwoProfilesOfOneName) {
  const Scenario known = load(kFullScenario);
  Profile other = *known.uavs[0].profile;
  other.file = scratch_.write("other/rig.toml", "name = \"rig\"\n");
  Scenario scenario = known;
  const Error error = thrown_error(ErrorCode::kBadFile, [&] { lay_profile(scenario, other); });
  EXPECT_EQ(error.where().file, other.file);
  EXPECT_THAT(error.what(), HasSubstr("which is also the name of the profile"));
}

TEST_F(LoadScenario, GivesEachUavItsOwnOrTheCommonSut) {
  const auto common = [&](const std::string& anchor) {
    return ElementsAre(Pair("anchor", anchor), Pair("mission", mission_),
                       Pair("precision_deg", "2.5"), Pair("retries", "3"), Pair("verbose", "true"));
  };
  const Scenario s = load(kFullScenario);
  EXPECT_THAT(s.uavs[0].sut.command, ElementsAre("own-sut", "--fast"));
  EXPECT_THAT(s.uavs[0].sut.parameters, ElementsAre(Pair("anchor", "red_box")));
  EXPECT_THAT(s.uavs[1].sut.command, ElementsAre("tether-sut", "face-anchor"));
  EXPECT_THAT(s.uavs[1].sut.parameters, common("blue_box"));
  EXPECT_FALSE(s.uavs[1].sut.concurrent);
  const Scenario concurrent = load_with("[sut]\n", "[sut]\nconcurrent = true\n");
  EXPECT_TRUE(concurrent.uavs[1].sut.concurrent);
  EXPECT_FALSE(concurrent.uavs[0].sut.concurrent) << "it has its own command";
  const Sut overriding = load_with("command = [\"own-sut\", \"--fast\"]\n", "").uavs[0].sut;
  EXPECT_THAT(overriding.command, ElementsAre("tether-sut", "face-anchor"));
  EXPECT_THAT(overriding.parameters, common("red_box"));
}

TEST_F(LoadScenario, GivesASutAbsolutePaths) {
  const std::string own = scratch_.write("own.toml", "");
  const Scenario s = load_with("[uav.sut.parameters]\nanchor = \"red_box\"",
                               "[uav.sut.files]\nmission = \"missions/../own.toml\"");
  EXPECT_THAT(s.uavs[0].sut.parameters, ElementsAre(Pair("mission", own)));
  EXPECT_THAT(s.files, testing::IsSupersetOf({own, mission_}));
  const auto program = [&](const std::string& written) {
    return load_with("[\"tether-sut\", ", "[\"" + written + "\", ").uavs[1].sut.command.front();
  };
  EXPECT_EQ(program("./bin/sut"), scratch_.path("bin/sut"));
  EXPECT_EQ(program("/opt/onboard/none"), "/opt/onboard/none") << "may exist on a board only";
}

TEST_F(LoadScenario, ReadsTheMissionOfASut) {
  const std::string file = scratch_.write("judged.toml", R"([[task]]
task = "search"
[[clause]]
within_s = 60
[[clause]]
never = "distance of red_box <= 1 m"
)");
  const std::string command = "command = [\"tether-sut\", \"face-anchor\"]\n";
  const std::string with_mission = command + "mission = \"judged.toml\"\n";
  const std::string files = "[sut.files]\nmission = \"missions/around.toml\"\n";
  const std::string text = replaced(replaced(kFullScenario, files, ""), command, with_mission);
  const Scenario s = load(text);
  ASSERT_TRUE(s.uavs[1].sut.mission);
  EXPECT_EQ(s.uavs[1].sut.mission->clauses.size(), 2u);
  EXPECT_THAT(s.uavs[1].sut.parameters, testing::Contains(Pair("mission", file)));
  EXPECT_THAT(s.files, testing::Contains(file));
  EXPECT_FALSE(s.uavs[0].sut.mission) << "it has its own command";

  expect_refusal(46, "mission", [&] { load(replaced(kFullScenario, command, with_mission)); });
  expect_refusal(3, "mission within 60 s",
                 [&] { load(replaced(text, "time_limit_s = 60", "time_limit_s = 50")); });
  expect_refusal(5, "mission: never distance of red_box <= 1 m", [&] {
    load(replaced(replaced(text, ", \"red_box\"]", "]"), "anchor = \"red_box\"\n\n[[uav]]",
                  "anchor = \"blue_box\"\n\n[[uav]]"));
  });
}

TEST_F(LoadScenario, ReadsConditions) {
  const Scenario s = load(kFullScenario);
  ASSERT_EQ(s.conditions.size(), 4u);
  EXPECT_EQ(s.conditions[0].policy, Policy::kConservativeBarrier);
  EXPECT_EQ(s.conditions[0].computers[0].clock.kind, computer::ClockKind::kCpu);
  EXPECT_EQ(s.conditions[0].computers[0].clock.factor, 1.5);
  EXPECT_EQ(s.conditions[0].computers[0].clock.computing, Duration(0));
  EXPECT_EQ(s.conditions[0].real_time_factor, 0.0);
  EXPECT_EQ(s.conditions[0].simulator, "mujoco");
  EXPECT_FALSE(s.conditions[0].computers[0].target);
  const Condition* no_sync = s.find_condition("target, no sync");
  ASSERT_NE(no_sync, nullptr);
  EXPECT_EQ(no_sync->policy, Policy::kFreeRunning);
  EXPECT_EQ(no_sync->computers[0].clock.kind, computer::ClockKind::kWall);
  EXPECT_EQ(no_sync->real_time_factor, 0.25);
  EXPECT_EQ(s.conditions[2].computers[0].clock.kind, computer::ClockKind::kScripted);
  EXPECT_EQ(s.conditions[2].computers[0].clock.computing, Duration(2'500'000));
  ASSERT_TRUE(s.conditions[3].computers[0].target);
  EXPECT_EQ(s.conditions[3].computers[0].target->name, "slow");
  EXPECT_EQ(s.conditions[3].computers[0].clock.kind, computer::ClockKind::kCpu);
  EXPECT_EQ(s.conditions[3].computers[0].clock.factor, 6.0);
  EXPECT_EQ(s.conditions[3].simulator, "gazebo");
  EXPECT_EQ(s.find_condition("nowhere"), nullptr);
  EXPECT_EQ(
      load_with("\"cpu\"\ncpu_factor = 1.5", "\"unstamped\"").conditions[0].computers[0].clock.kind,
      computer::ClockKind::kUnstamped);
}

TEST_F(LoadScenario, ReadsProfilesAndAppliesAnotherOnTop) {
  Scenario s = load(kFullScenario);
  EXPECT_EQ(s.uavs[0].profile->file, scratch_.path("profiles/rig.toml"));
  EXPECT_FALSE(s.uavs[1].profile);
  EXPECT_THAT(profile_names(s, s.conditions[2]), ElementsAre("rig", "fog"));
  const auto file = scratch_.write("top.toml", replaced(kRigProfile, "\"rig\"", "\"top\""));
  lay_profile(s, load_profile(file));
  EXPECT_THAT(s.files, Contains(file));
  EXPECT_TRUE(std::is_sorted(s.files.begin(), s.files.end()));
  s.uavs[1].profile = s.uavs[0].profile;
  EXPECT_THAT(profile_names(s, s.conditions[0]), ElementsAre("rig", "top"));
  lay_profile(s, *s.uavs[0].profile);
  EXPECT_THAT(profile_names(s, s.conditions[2]), ElementsAre("fog", "top", "rig"))
      << "once, at its topmost layer";
}

TEST_F(LoadScenario, ReadsMetrics) {
  const Scenario s = load(kFullScenario);
  ASSERT_EQ(s.metrics.size(), 3u);
  EXPECT_EQ(s.metrics[0].name, "time_required_uav1");
  EXPECT_EQ(s.metrics[0].label, "Time required, uav1");
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
  EXPECT_EQ(s.metrics[2].sensor, "camera");
  EXPECT_EQ(s.metrics[2].line, 99);
}

TEST_F(LoadScenario, ReadsLimitsOfContacts) {
  const std::string metrics = R"([[metric]]
kind = "min_clearance_m"
uav = "uav1"
min_m = 0.2
[[metric]]
kind = "collisions"
uav = "uav1"
)";
  const auto with = [&](const std::string& speed, const std::string& threshold) {
    return load(replaced(kFullScenario, "time_limit_s", speed + "\ntime_limit_s") + metrics +
                threshold);
  };
  const Scenario s = with("", "");
  EXPECT_EQ(s.max_contact_speed_m_s, 0.5);
  EXPECT_EQ(s.metrics[3].min, 0.2);
  EXPECT_FALSE(s.metrics[3].max);
  EXPECT_TRUE(s.metrics[3].of_any_flight);
  struct {
    const char *speed, *threshold;
    double max_m_s, threshold_m_s;
  } const cases[] = {{"", "", 0.5, 0.5},
                     {"max_contact_speed_m_s = 2", "", 2.0, 2.0},
                     {"max_contact_speed_m_s = inf", "", HUGE_VAL, 0.5},
                     {"max_contact_speed_m_s = 2", "threshold_m_s = 1", 2.0, 1.0}};
  for (const auto& c : cases) {
    EXPECT_EQ(with(c.speed, c.threshold).max_contact_speed_m_s, c.max_m_s);
    EXPECT_EQ(with(c.speed, c.threshold).metrics[4].threshold_m_s, c.threshold_m_s);
  }
}

TEST_F(LoadScenario, TakesTheOnlyUavAndTheOnlyAnchorAsDefaults) {
  const Scenario s = load(R"(name = "small"
world = "worlds/room.sdf"
time_limit_s = 10
anchors = ["blue_box"]
uav = [{ name = "uav1", model = "models/uav.sdf", position_m = [0, 0, 1] }]
sut = { command = ["tether-sut"] }
condition = [{ name = "host", policy = "conservative_barrier", clock = "cpu" }]
metric = [{ kind = "oscillations" }]
)");
  EXPECT_EQ(s.metrics[0].uav, "uav1");
  EXPECT_EQ(s.metrics[0].anchor, "blue_box");
  EXPECT_DOUBLE_EQ(s.metrics[0].threshold_rad, rad_from_deg(1));
  EXPECT_EQ(s.step, std::nullopt) << "the world's";
  EXPECT_FALSE(s.record_images);
}

TEST_F(LoadScenario, RefusesWrongSuts) {
  const std::string sut =
      kFullScenario.substr(kFullScenario.find("[sut]"),
                           kFullScenario.find("[[condition]]") - kFullScenario.find("[sut]"));
  const std::string mission = "mission = \"missions/around.toml\"";
  const std::string command = "command = [\"tether-sut\", ";
  expect_refused(
      {{sut, "", 39, "[uav]"},
       {"[\"own-sut\", \"--fast\"]", "[]", 34, "command"},
       {"retries = 3", "\"--x\" = 3", 50, "--x"},
       {"retries = 3", "retries = [3]", 50, "retries"},
       {"retries = 3", "retries = \"a\\u0000b\"", 50, "retries"},
       {mission, "mission = \"missions/none.toml\"", 54, "mission"},
       {mission, "Mission = \"missions/around.toml\"", 54, "Mission"},
       {mission, "anchor = \"missions/around.toml\"", 54, "anchor"},
       {command, "all_processes = true\n" + command, 45, "all_processes"},
       {command, "concurrent = true\nas_is = true\n" + command, 45, "concurrent"},
       {command, "as_is = true\ncommand = [\"tether-exec\", ", 45, "as_is"},
       {command, "concurrent = true\ncommand = [\"tether-exec\", ", 45, "concurrent"},
       {command, "concurrent = true\ncommand = [\"/usr/bin/tether-exec\", ", 45, "concurrent"}});
}

TEST_F(LoadScenario, RefusesWrongNames) {
  expect_refused({{"name = \"full\"", "name = \"../up\"", 1, "name"},
                  {"name = \"uav2\"", "name = \"uav1\"", 40, "name"},
                  {"name = \"target, no sync\"", "name = \"Host!\"", 64, "name"},
                  {"name = \"scripted\"", "name = \"--\"", 70, "name"},
                  {"name = \"swings\"", "name = \"time_required_uav1\"", 89, "name"},
                  {"acquisition_time\"\nuav = \"uav1\"\nsensor = \"camera\"",
                   "time_required\"\nuav = \"uav1\"", 97, "kind"},
                  {"\"red_box\"]", "\"blue_box\"]", 7, "anchors"},
                  {"[\"blue_box\", \"red_box\"]", "[]", 88, "kind"},
                  {"worlds/room.sdf", "worlds/rom.sdf", 3, "world"},
                  {"profiles/fog.toml", "profiles/frog.toml", 74, "profile"},
                  {"targets/slow.toml", "targets/slaw.toml", 79, "target"}});
}

TEST_F(LoadScenario, RefusesWrongConditions) {
  const std::string target = "target = \"profiles/targets/slow.toml\"";
  const std::string factor = "real_time_factor = 0.25";
  scratch_.write("scaled.toml", "name = \"scaled\"\nclock = \"wall\"\ncpu_factor = 2\n");
  expect_refused({{"\"conservative_barrier\"", "\"conservative\"", 59, "policy"},
                  {"\"gazebo\"", "\"gazeebo\"", 80, "simulator"},
                  {target, "", 76, "clock"},
                  {target, target + "\nclock = \"cpu\"", 80, "clock"},
                  {target, target + "\ncpu_factor = 2", 80, "cpu_factor"},
                  {target, target + "\ncomputing_ms = 2", 80, "computing_ms"},
                  {"clock = \"wall\"", "target = \"scaled.toml\"", 66, "target"},
                  {factor, "", 63, "real_time_factor"},
                  {factor, factor + "\ncpu_factor = 2", 68, "cpu_factor"},
                  {"cpu_factor = 1.5", "computing_ms = 2", 61, "computing_ms"},
                  {"computing_ms = 2.5", "computing_ms = 0", 73, "computing_ms"},
                  {"clock = \"wall\"", "clock = \"scripted\"\ncomputing_ms = 1", 66, "clock"},
                  {"clock = \"wall\"", "clock = \"unstamped\"", 66, "clock"}});
}

TEST_F(LoadScenario, RefusesWrongMetricsAndNumbers) {
  const std::string limit = "max_s = 30";
  expect_refused(
      {{"\"oscillations\"", "\"oscilations\"", 88, "kind"},
       {"anchor = \"red_box\"\nthreshold", "anchor = \"rd_box\"\nthreshold", 92, "anchor"},
       {limit, "sensor = \"camera\"", 85, "sensor"},
       {limit, "anchor = \"red_box\"", 85, "anchor"},
       {limit, "threshold_deg = 1", 85, "threshold_deg"},
       {limit, "max_m = 30", 85, "max_m"},
       {limit, "min_m = 30", 85, "min_m"},
       {limit, "threshold_m_s = 1", 85, "threshold_m_s"},
       {"hang_limit_s", "max_contact_speed_m_s = -1\nhang_limit_s", 6, "max_contact_speed_m_s"},
       {"position_m = [1, -2.5, 1.2]", "position_m = [1, 2]", 12, "position_m"},
       {"_period_ms = 20", "_period_ms = 0", 102, "ground_truth_period_ms"}});
}

TEST_F(LoadScenario, LocatesErrorsInFilesThatItNames) {
  const auto file_of = [&](const std::string& from, const std::string& to) {
    return bad_file_error([&] { load_with(from, to); }).where().file;
  };
  EXPECT_EQ(file_of("profiles/rig.toml", "delays.txt"), scratch_.path("delays.txt"));
  EXPECT_EQ(file_of("targets/slow.toml", "fog.toml"), scratch_.path("profiles/fog.toml"));
}

TEST(Slug, IsAFileName) {
  EXPECT_EQ(slug("target, no sync"), "target-no-sync");
  EXPECT_EQ(slug("  Host (1)  "), "host-1");
  EXPECT_EQ(slug("../.."), "");
}

}  // namespace
}  // namespace tether::scenario
